"""Every PATCH of the contract names the members it knows where one is given that it does not know, and changes nothing then."""
from __future__ import annotations

import re
import unittest
from typing import Any

import samples
from suite import DaemonTest

# Members of bytes, not of a document: the resumable upload protocol (tests/api/resumable_test.py).
OF_BYTES = {"appendToUpload"}


class Patches(DaemonTest):
    def resources(self) -> dict[str, str]:
        """The address of a resource for each operation."""
        recording = self.expect(201, self.daemon.upload(samples.gyro_csv(seed=1), device="patched", rate_hz=100, columns=samples.GYRO_Z))
        webhook = self.expect(201, self.daemon.post("/v1/webhooks", {"url": "https://ci.example.org/hook"}))
        return {"changeDevice": "/v1/devices/patched", "changeRecording": recording.headers["location"], "changeWebhook": webhook.headers["location"]}

    def members(self, schema: dict[str, Any]) -> list[str]:
        while "$ref" in schema:
            place: Any = self.contract.whole
            for step in schema["$ref"].removeprefix("#/").split("/"):
                place = place[step]
            schema = place
        return sorted(schema["properties"])

    def test_an_unknown_member_is_answered_with_those_that_are_known(self) -> None:
        operations = {path["patch"]["operationId"]: path["patch"] for path in self.contract.paths.values() if "patch" in path}
        resources = self.resources()
        self.assertEqual(set(resources), set(operations) - OF_BYTES, "each PATCH has a resource here")
        for name, address in resources.items():
            with self.subTest(operation=name):
                before = self.expect(200, self.daemon.get(address))
                known = self.members(operations[name]["requestBody"]["content"]["application/json"]["schema"])
                self.assertNotIn("colour", known)
                for match in ("*", before.headers["etag"]):
                    problem = self.problem(400, "invalid_argument", self.daemon.request("PATCH", address, {"colour": "red"}, {"If-Match": match}))
                    [error] = problem["errors"]  # type: ignore[misc]
                    self.assertEqual(error["pointer"], "/colour")
                    sentence = re.fullmatch(r"The member 'colour' is not known here; known are ([a-z_, ]+)\.", error["detail"])
                    assert sentence is not None, error["detail"]
                    self.assertEqual(sorted(sentence.group(1).split(", ")), known)
                # Beside a member that is known, which must not be changed either.
                value = {"changeDevice": {"serial": "1"}, "changeRecording": {"session": "Monday"}, "changeWebhook": {"description": "x"}}[name]
                self.expect(400, self.daemon.request("PATCH", address, {**value, "colour": "red"}, {"If-Match": "*"}))
                self.assertEqual(self.daemon.get(address).json, before.json)

    def test_a_recording_has_a_name_of_its_user_and_no_file_there(self) -> None:
        """Uploads take `id` for the user's name of the recording, beside its id, and ignore `file`; a stored recording has no such member."""
        recording = self.expect(201, self.daemon.upload(samples.gyro_csv(seed=2), device="named", rate_hz=100, columns=samples.GYRO_Z)).json
        address = f"/v1/recordings/{recording['id']}"
        problem = self.problem(400, "invalid_argument", self.daemon.request("PATCH", address, {"file": "other.csv"}, {"If-Match": "*"}))
        [error] = problem["errors"]  # type: ignore[misc]
        self.assertEqual(error["pointer"], "/file")
        self.assertEqual(self.daemon.get(address).json, recording)
        named = self.expect(200, self.daemon.request("PATCH", address, {"id": "rate-9-run-1"}, {"If-Match": "*"})).json
        self.assertEqual((named["id"], named["metadata"]["id"]), (recording["id"], "rate-9-run-1"))


if __name__ == "__main__":
    unittest.main()
