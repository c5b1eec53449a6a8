"""Jobs over HTTP: uniqueness, waiting, events, cancellation, failure; and the tables that come of them."""
from __future__ import annotations

import csv
import io
import json
import threading
import time
import unittest
import urllib.parse

import samples
from daemon import events
from suite import DaemonTest

FINAL = {"succeeded", "failed", "cancelled", "dead"}


class JobTest(DaemonTest):
    # One worker, so that a job behind a long one stays queued for as long as the test needs.
    arguments = ("--workers", "1")

    def recording(self, seed: int, samples_: int = 512, **query: object) -> str:
        answer = self.daemon.upload(samples.gyro_csv(samples_, seed=seed), **{"rate_hz": 100, "columns": samples.GYRO_Z, **query})
        return str(self.expect(201, answer).json["id"])

    def long_recording(self, seed: int) -> str:
        """Six channels of 2^18 samples: a worker is busy with it for longer than a request takes."""
        columns = [samples.noise(1 << 12, 1, seed + i)[0] * 64 for i in range(6)]
        roles = ",".join(f"{i}={'angular_rate' if i < 3 else 'specific_force'}:{'xyz'[i % 3]}:{'deg/s' if i < 3 else 'g'}" for i in range(6))
        return str(self.expect(201, self.daemon.upload(samples.npy(columns), device=f"long-{seed}", rate_hz=100, columns=roles)).json["id"])


class Structures(JobTest):
    def test_recordings_of_any_devices_have_one_structure_or_not(self) -> None:
        ids = [self.recording(seed, 4096, device=f"structure-{seed}") for seed in (71, 72)]
        asked = "/v1/structures?of=" + ",".join(f"{id}:gz" for id in ids)
        self.problem(404, "not_found", self.daemon.get(asked))
        for id in ids:
            self.daemon.finished(self.daemon.characterise(id, models=["WN", "WN+GM"]).json["id"])
        told = self.expect(200, self.daemon.get(asked)).json
        self.assertEqual((told["verdict"], told["common"]), ("one_structure", "WN"), told)
        self.assertIn("They have one structure: WN describes every recording", told["statement"])
        self.assertEqual([each["label"] for each in told["by_condition"]], [f"{id}:gz" for id in ids])
        self.assertEqual({each["model"] for each in told["ranking"]}, {"WN", "WN+GM"})
        self.assertEqual(self.daemon.get("/v1/structures?of=" + ",".join(ids)).json, told, "the first channel")
        for wrong in ("", "?of=", f"?of={ids[0]}", "?of=" + ",".join(ids * 5), f"?of={ids[0]},{ids[1]}:%25zz"):
            self.problem(400, "invalid_argument", self.daemon.get("/v1/structures" + wrong), parameter="of")
        self.problem(404, "not_found", self.daemon.get(asked + "x"))


class Life(JobTest):
    def test_the_daemon_says_how_many_jobs_run_at_a_time(self) -> None:
        self.assertEqual(self.expect(200, self.daemon.get("/v1/workers")).json, {"workers": 1})

    def test_upload_queues_nothing_and_a_job_runs_to_its_result(self) -> None:
        jobs = self.daemon.items("/v1/jobs")
        recording = self.recording(1)
        self.assertEqual(self.daemon.items("/v1/jobs"), jobs)
        queued = self.expect(202, self.daemon.characterise(recording))
        self.assertEqual(queued.headers["location"], "/v1/jobs/" + queued.json["id"])
        self.assertIn("retry-after", queued.headers)
        job = self.daemon.finished(queued.json["id"])
        self.assertEqual((job["state"], job["progress"], job["attempt"], job["problem"]), ("succeeded", 1, 1, None), job)
        [found] = self.expect(200, self.daemon.get(job["result"]["href"])).json["recordings"]
        self.assertEqual(found["id"], recording)
        [channel] = found["channels"]
        self.assertEqual((channel["unit"], channel["samples"], channel["axis"]), ("deg/s", 512, "z"))
        self.assertEqual([fit["model"] for fit in channel["fits"]].count("WN"), 1)
        criteria = [fit["wic"] for fit in channel["fits"] if fit["wic"] is not None]
        self.assertEqual(criteria, sorted(criteria))
        behind = [fit["distance_2p"] for fit in channel["fits"]]
        self.assertEqual((min(behind), [fit["closest"] for fit in channel["fits"]].count(True)), (0, 1))
        self.assertEqual([distance <= 6 for distance in behind], [fit["plausible"] for fit in channel["fits"]])
        listed = self.daemon.items(f"/v1/fits?job={job['id']}")
        self.assertEqual(len(listed), len(channel["fits"]))
        self.assertEqual({fit["rank"] for fit in listed}, set(range(len(listed))))
        [best] = self.daemon.items(f"/v1/fits?job={job['id']}&best=true")
        self.assertEqual((best["rank"], best["model"], best["wic"]), (0, channel["fits"][0]["model"], channel["fits"][0]["wic"]))
        self.assertEqual(self.daemon.get(f"/v1/fits/{best['id']}").json, best)
        self.problem(404, "not_found", self.daemon.get("/v1/fits/fit_nobody"))

    def test_characterise_stores_its_models_with_units_settings_seed_and_version(self) -> None:
        recording = self.recording(7, samples_=2048)
        job = self.daemon.finished(self.expect(202, self.daemon.characterise(recording, seed=17)).json["id"])
        self.assertEqual(job["state"], "succeeded", job)
        listed = self.daemon.items(f"/v1/fits?job={job['id']}")
        self.assertLessEqual({"WN", "WN+GM", "WN+GM+RW"}, {fit["model"] for fit in listed})
        units = {("white_noise", "N"): "deg/sqrt(h)", ("gauss_markov", "sigma"): "deg/h", ("gauss_markov", "beta"): "1/s",
                 ("random_walk", "K"): "deg/h/sqrt(h)"}
        seen = set()
        for fit in listed:
            for process in fit["processes"]:
                for name, value in process["params"].items():
                    place = (process["process"], name)
                    if value is not None and place in units:
                        self.assertEqual(value["unit"], units[place], fit["model"])
                        seen.add(place)
        self.assertIn(("white_noise", "N"), seen)
        [(stored, document)] = self.daemon.rows("SELECT settings_json, document_json FROM channel_results WHERE job_id = ?", job["id"])
        settings, channel = json.loads(stored), json.loads(document)
        self.assertEqual(settings["seed"], 17)
        self.assertGreaterEqual(settings["algorithm_version"], 1)
        self.assertLessEqual({"WN", "WN+GM", "WN+GM+RW"}, set(settings["models"]))
        self.assertTrue(settings["driftlab_version"])
        self.assertEqual((channel["unit"], channel["allan_parameters"]["N"]["unit"]), ("deg/s", "deg/sqrt(h)"))

    def test_same_request_is_the_same_job(self) -> None:
        recording = self.recording(2)
        first = self.expect(202, self.daemon.characterise(recording, models=["WN"], seed=3))
        self.assertEqual(self.expect(200, self.daemon.characterise(recording, recording, models=["WN"], seed=3)).json["id"], first.json["id"])
        self.daemon.finished(first.json["id"])
        again = self.expect(200, self.daemon.characterise(recording, models=["WN"], seed=3))
        self.assertEqual((again.json["id"], again.json["state"]), (first.json["id"], "succeeded"))
        self.assertNotIn("retry-after", again.headers)
        other = self.expect(202, self.daemon.characterise(recording, models=["WN"], seed=4))
        self.assertNotEqual(other.json["id"], first.json["id"])

    def test_same_seed_gives_the_same_bits(self) -> None:
        results = []
        for device in ("bits-1", "bits-2"):
            recording = self.recording(3, device=device)
            job = self.daemon.finished(self.daemon.characterise(recording, models=["WN", "WN+GM"]).json["id"])
            results.append(self.daemon.get(job["result"]["href"]).body.replace(recording.encode(), b"REC"))
        self.assertEqual(results[0], results[1])

    def test_idempotency_key_gives_the_stored_answer(self) -> None:
        recording, key = self.recording(4), {"Idempotency-Key": "job-1"}
        first = self.expect(202, self.daemon.characterise(recording, models=["WN"], headers=key))
        self.daemon.finished(first.json["id"])
        again = self.expect(202, self.daemon.characterise(recording, models=["WN"], headers=key))
        self.assertEqual((again.body, again.headers["idempotency-replayed"]), (first.body, "true"))
        self.problem(422, "idempotency_key_reused", self.daemon.characterise(recording, models=["WN+GM"], headers=key))

    def test_a_job_names_what_it_is_about(self) -> None:
        recording, other = self.recording(31, device="named-1", id="rest"), self.recording(32, device="named-1")
        queued = self.expect(202, self.daemon.characterise(recording, models=["WN"])).json
        one = self.daemon.finished(queued["id"])
        for document in (queued, one, self.daemon.characterise(recording, models=["WN"]).json, next(j for j in self.daemon.items("/v1/jobs") if j["id"] == one["id"])):
            self.assertEqual((document["device_name"], document["recording_name"]), ("named-1", "rest"))
        both = self.daemon.finished(self.daemon.characterise(recording, other, models=["WN"]).json["id"])
        self.assertEqual((both["device_name"], both["recording_name"]), ("named-1", None))
        elsewhere = self.recording(33, device="named-2")
        several = self.daemon.finished(self.daemon.characterise(recording, elsewhere, models=["WN"]).json["id"])
        self.assertEqual((several["device_name"], several["recording_name"]), (None, None))

    def test_failed_job_tells_its_problem_and_may_be_queued_again(self) -> None:
        recording = self.recording(5, samples_=5)  # enough to be a recording, too few for the analysis
        # Waiting on the POST must not queue it again and again.
        first = self.expect(202, self.daemon.characterise(recording, headers={"Prefer": "wait=5"}))
        job = self.daemon.finished(first.json["id"])
        self.assertEqual((job["state"], job["result"]), ("failed", None))
        self.assertEqual((job["problem"]["code"], job["problem"]["where"]["column"]), ("too_few_samples", "gz"))
        self.assertEqual(job["failed_attempts"], [job["problem"]], "a fault of the input is final at once")
        self.problem(404, "not_found", self.daemon.get(f"/v1/jobs/{job['id']}/result"), state="failed")
        self.assertEqual(len([j for j in self.daemon.items("/v1/jobs?state=failed") if j["id"] == job["id"]]), 1)
        again = self.expect(202, self.daemon.characterise(recording))
        self.assertNotEqual(again.json["id"], job["id"])

    def test_faults_of_a_request_are_named(self) -> None:
        recording = self.recording(6)
        cases = [
            ({"kind": "nap", "inputs": {}}, 400, {"/kind"}),
            ({"kind": "", "inputs": {}}, 400, {"/kind"}),
            ({"inputs": {"recordings": [recording]}}, 400, {"/kind"}),
            ({"kind": "characterise"}, 400, {"/inputs/recordings"}),
            ({"kind": "characterise", "inputs": {"recordings": []}}, 400, {"/inputs/recordings"}),
            ({"kind": "characterise", "inputs": {"recordings": ["x", 4]}}, 400, {"/inputs/recordings/0", "/inputs/recordings/1"}),
            ({"kind": "characterise", "inputs": {"recordings": ["rec_" + "0" * 26]}}, 404, {"/inputs/recordings"}),
            ({"kind": "characterise", "inputs": {"recordings": [recording], "files": []}}, 400, {"/inputs/files"}),
            ({"kind": "characterise", "inputs": {"recordings": [recording]}, "parameters": {"models": ["WN+XX"]}}, 400, {"/parameters/models"}),
            ({"kind": "characterise", "inputs": {"recordings": [recording]}, "parameters": {"seed": -1, "sed": 1}}, 400, {"/parameters/seed", "/parameters/sed"}),
            ({"kind": "characterise", "inputs": {"recordings": [recording]}, "priority": 10}, 400, {"/priority"}),
            ({"kind": "characterise", "inputs": {"recordings": [recording]}, "priorty": 1}, 400, {"/priorty"}),
        ]
        before = len(self.daemon.items("/v1/jobs"))
        for body, status, pointers in cases:
            with self.subTest(body=body):
                answer = self.expect(status, self.daemon.post("/v1/jobs", body))
                self.assertEqual({error["pointer"] for error in answer.json["errors"]}, pointers, answer.describe())
        self.assertEqual(len(self.daemon.items("/v1/jobs")), before)
        self.problem(400, "invalid_argument", self.daemon.get("/v1/jobs?state=asleep"), parameter="state")


class Events(JobTest):
    def test_events_come_in_order_and_the_stream_closes_after_the_last(self) -> None:
        job = self.expect(202, self.daemon.characterise(self.long_recording(10))).json["id"]
        seen = list(events(self.daemon, job))  # follows the job live
        self.assertEqual([e.id for e in seen], sorted({e.id for e in seen}))
        states = [e.data["state"] for e in seen if e.type == "state"]
        self.assertEqual(states, ["queued", "running", "succeeded"])
        self.assertEqual((seen[-1].type, seen[-1].data["progress"]), ("state", 1))
        fractions = [e.data["progress"] for e in seen]
        self.assertEqual(fractions, sorted(fractions))
        stages = {e.data["stage"] for e in seen if e.type == "progress"}
        self.assertTrue(any(stage.startswith("5: ") for stage in stages), stages)
        for event in seen:
            self.assertEqual(event.data["job"], job)
            self.contract.match(event.data, {"$ref": "#/$defs/job.schema.json/$defs/event"})
        for position in (0, len(seen) // 2, len(seen) - 2):
            self.assertEqual(list(events(self.daemon, job, last=seen[position].id)), seen[position + 1:])
        self.assertEqual(list(events(self.daemon, job, last=seen[-1].id)), [])

    def test_a_stream_says_what_it_is_and_when_to_come_back(self) -> None:
        job = self.expect(202, self.daemon.characterise(self.recording(14), models=["WN"])).json["id"]
        raw = self.daemon.exchange(f"GET /v1/jobs/{job}/events HTTP/1.1\r\nHost: 127.0.0.1:{self.daemon.port}\r\n\r\n".encode())
        head, _, body = raw.partition(b"\r\n\r\n")
        status, *lines = head.decode("latin-1").split("\r\n")
        self.assertEqual(status, "HTTP/1.1 200 OK")
        fields = {name.lower(): value.strip() for name, _, value in (line.partition(":") for line in lines)}
        wanted = {"content-type": "text/event-stream", "cache-control": "no-cache", "x-accel-buffering": "no"}
        self.assertEqual({name: fields.get(name) for name in wanted}, wanted)
        self.assertTrue(body.startswith(b"retry: 3000\n\n"), body[:80])

    def test_stream_faults(self) -> None:
        self.problem(404, "not_found", self.daemon.get("/v1/jobs/job_nobody/events"))
        job = self.expect(202, self.daemon.characterise(self.recording(11), models=["WN"])).json["id"]
        self.problem(400, "invalid_argument", self.daemon.get(f"/v1/jobs/{job}/events", Last_Event_ID="x"), parameter="Last-Event-ID")
        self.expect(200, self.daemon.request("HEAD", f"/v1/jobs/{job}/events"))

    def test_prefer_wait_answers_when_the_job_has_ended(self) -> None:
        job = self.expect(202, self.daemon.characterise(self.recording(12), models=["WN"])).json["id"]
        answer = self.expect(200, self.daemon.get(f"/v1/jobs/{job}", Prefer="wait=60"))
        self.assertIn(answer.json["state"], FINAL)
        etag = answer.headers["etag"]
        self.expect(304, self.daemon.get(f"/v1/jobs/{job}", If_None_Match=etag, Prefer="wait=60"))

    def test_prefer_wait_gives_up_when_its_time_is_over(self) -> None:
        blocker = self.expect(202, self.daemon.characterise(self.long_recording(20))).json["id"]
        behind = self.expect(202, self.daemon.characterise(self.recording(13), models=["WN"])).json["id"]
        start = time.monotonic()
        answer = self.expect(200, self.daemon.get(f"/v1/jobs/{behind}", Prefer="wait=1"))
        took = time.monotonic() - start
        if answer.json["state"] == "queued":
            self.assertGreaterEqual(took, 1.0)
            self.assertIn("retry-after", answer.headers)
        else:
            self.assertIn(self.daemon.get(f"/v1/jobs/{blocker}").json["state"], FINAL)
        self.daemon.finished(behind)


class Cancellation(JobTest):
    def test_queued_and_running_jobs_stop(self) -> None:
        running = self.expect(202, self.daemon.characterise(self.long_recording(30))).json["id"]
        queued = self.expect(202, self.daemon.characterise(self.recording(31), models=["WN"])).json["id"]
        following = events(self.daemon, running)
        for event in following:
            if event.type == "progress":
                break  # it works now
        self.assertEqual(self.daemon.get(f"/v1/jobs/{queued}").json["state"], "queued")
        answer = self.expect(202, self.daemon.post(f"/v1/jobs/{queued}/cancel"))
        self.assertEqual(answer.json["state"], "cancelled")
        asked = self.expect(202, self.daemon.post(f"/v1/jobs/{running}/cancel"))
        self.assertTrue(asked.json["cancel_requested"])
        self.assertEqual([event.data["state"] for event in following if event.type == "state"], ["cancelled"])
        for job in (queued, running):
            document = self.daemon.finished(job)
            self.assertEqual((document["state"], document["result"]), ("cancelled", None))
            self.assertEqual(self.daemon.items(f"/v1/fits?job={job}"), [])
        self.problem(404, "not_found", self.daemon.post("/v1/jobs/job_nobody/cancel"))

    def test_cancelled_job_may_be_queued_again(self) -> None:
        self.expect(202, self.daemon.characterise(self.long_recording(40)))
        recording = self.recording(41)
        first = self.expect(202, self.daemon.characterise(recording, models=["WN"])).json["id"]
        self.daemon.post(f"/v1/jobs/{first}/cancel")
        again = self.daemon.characterise(recording, models=["WN"])
        self.assertEqual(self.daemon.finished(again.json["id"])["state"], "succeeded")

    def test_recording_in_use_is_not_deleted(self) -> None:
        recording = self.long_recording(50)
        job = self.expect(202, self.daemon.characterise(recording)).json["id"]
        etag = self.daemon.get(f"/v1/recordings/{recording}").headers["etag"]
        self.problem(409, "conflict", self.daemon.request("DELETE", f"/v1/recordings/{recording}", headers={"If-Match": etag}), job=job)
        self.daemon.post(f"/v1/jobs/{job}/cancel")
        self.daemon.finished(job)
        self.expect(204, self.daemon.request("DELETE", f"/v1/recordings/{recording}", headers={"If-Match": etag}))


class Load(JobTest):
    arguments = ()

    def test_many_clients_at_once_get_whole_answers(self) -> None:
        faults: list[BaseException] = []

        def client(number: int) -> None:
            try:
                recording = self.recording(100 + number, device=f"client-{number}")
                job = self.daemon.finished(self.daemon.characterise(recording, models=["WN"]).json["id"])
                self.assertEqual(job["state"], "succeeded")
                self.assertEqual(len(self.daemon.items(f"/v1/fits?device=client-{number}")), 1)
            except BaseException as fault:  # noqa: BLE001 - reported below
                faults.append(fault)

        threads = [threading.Thread(target=client, args=(i,)) for i in range(12)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(faults, [])
        self.assertEqual(len(self.daemon.items("/v1/jobs?state=succeeded")), 12)


class Tables(JobTest):
    @classmethod
    def setUpClass(cls) -> None:
        super().setUpClass()
        daemon = cls.daemon
        recordings = []
        for seed, condition in ((200, "constant_rate:z:40:deg/s"), (201, "constant_rate:z:9:deg/s"), (202, "static"), (203, "static")):
            answer = daemon.upload(samples.gyro_csv(4000, seed=seed), device="phone, \"07\"", condition=condition, rate_hz=100, columns=samples.GYRO_Z)
            recordings.append(answer.json["id"])
        daemon.finished(daemon.characterise(*recordings, models=["WN", "WN+GM"]).json["id"])
        cls.recordings = recordings
        cls.target = "/v1/parameter-tables?" + urllib.parse.urlencode({"device": 'phone, "07"', "sensor": "gyroscope", "axis": "z"})
        pooling = daemon.get(cls.target, Prefer="wait=60").json["pooling"]
        assert pooling["state"] == "done", pooling

    def test_a_filtered_sensor_has_one_density_in_table_summary_and_stored_fit(self) -> None:
        """The summary showed the white noise of the best model: nothing, or the wrong number, for a sensor behind a filter."""
        noise = samples.noise(40_003, 1, seed=31)[0]
        averaged = [sum(noise[i:i + 4]) / 4 for i in range(len(noise) - 3)]
        device = "filtered-01"
        recording = self.expect(201, self.daemon.upload(samples.csv([averaged], ["gz"]), device=device, rate_hz=100, columns=samples.GYRO_Z)).json["id"]
        self.assertEqual(self.daemon.finished(self.daemon.characterise(recording).json["id"])["state"], "succeeded")
        row = self.daemon.get(f"/v1/parameter-tables?device={device}&sensor=gyroscope&axis=z", Prefer="wait=60").json["rows"][0]
        shown = self.daemon.get(f"/v1/devices/{device}/summary").json["channels"][0]["N"]
        fits = self.daemon.items(f"/v1/fits?device={device}&best=true")
        self.assertAlmostEqual(row["density"]["value"], 6.0, delta=0.2)  # 1 deg/s at 100 Hz: 0.1 deg/s/sqrt(Hz) = 6 deg/sqrt(h)
        self.assertEqual(shown["value"], row["density"]["value"])
        self.assertEqual([fit["density"] for fit in fits], [shown])

    def test_rows_are_conditions_and_replicates_share_one(self) -> None:
        table = self.expect(200, self.daemon.get(self.target)).json
        self.assertEqual([row["label"] for row in table["rows"]], ["static", "9 deg/s about z", "40 deg/s about z"])
        self.assertEqual(set(table["rows"][0]["recordings"]), set(self.recordings[2:]))
        for row in table["rows"]:
            self.assertEqual(set(row["values"]), {column["key"] for column in table["columns"]})
            cell = row["values"]["white_noise.N"]
            self.assertLess(cell["ci95"][0], cell["value"])
            self.assertLess(cell["value"], cell["ci95"][1])
            # unit white noise at 100 Hz: N = sqrt(dt) deg/s/sqrt(Hz) = 60 sqrt(dt) deg/sqrt(h) = 6; 4000 samples give it to 3 %
            self.assertAlmostEqual(cell["value"], 6.0, delta=0.3)
        self.assertIsNone(table["rows"][0]["values"]["white_noise.N"]["change"])
        self.assertIn(table["rows"][1]["values"]["white_noise.N"]["change"], ("up", "down", "none"))

    def test_csv_says_the_same_as_json(self) -> None:
        for method in ("gmwm", "av"):
            table = self.expect(200, self.daemon.get(f"{self.target}&method={method}")).json
            answer = self.expect(200, self.daemon.get(f"{self.target}&method={method}", Accept="text/csv"))
            self.assertTrue(answer.headers["content-type"].startswith("text/csv"))
            self.assertEqual(answer.headers["vary"], "Accept")
            header, *rows = list(csv.reader(io.StringIO(answer.text, newline="")))
            self.assertEqual(len(rows), len(table["rows"]))
            # White noise alone identifies neither B nor K; the columns say in what unit they would be all the same.
            wanted_units = {"av": {"N": "deg/sqrt(h)", "B": "deg/h", "K": "deg/h/sqrt(h)"},
                            "gmwm": {"white_noise.N": "deg/sqrt(h)"}}[method]
            units = {column["key"]: column["unit"] for column in table["columns"]}
            self.assertLessEqual(wanted_units.items(), units.items())
            self.assertTrue(all(units.values()), units)
            for row, line in zip(table["rows"], rows):
                self.assertEqual(line[0], row["label"])
                self.assertEqual(line[1].split(), row["recordings"])
                # Before the parameters of a model stands the low-frequency density N, whatever the model.
                cells = [(column, row["values"][column["key"]]) for column in table["columns"]]
                if method == "gmwm":
                    cells.insert(0, ({"key": "N", "unit": row["density"]["unit"]}, row["density"]))
                for i, (column, cell) in enumerate(cells):
                    self.assertEqual(header[2 + 3 * i:5 + 3 * i], [f"{column['key']}{part} [{column['unit']}]" for part in ("", " low", " high")])
                    wanted = ["", "", ""] if cell is None else [cell["value"], *cell["ci95"]]
                    self.assertEqual([float(x) if x else "" for x in line[2 + 3 * i:5 + 3 * i]], ["" if w is None else w for w in wanted])

    def test_text_is_aligned(self) -> None:
        answer = self.expect(200, self.daemon.get(f"{self.target}&method=av", Accept="text/plain"))
        title, _, head, units, rule, *rows = answer.text.rstrip("\n").split("\n")
        self.assertIn("Allan variance", title)
        self.assertIn("N", head)
        self.assertIn("deg/sqrt(h)", units)
        self.assertEqual(set(rule), {"-", " "})
        starts = [0] + [i + 2 for i in range(len(rule) - 2) if rule[i:i + 2] == "  "]
        for line in (head, *rows):
            for start in starts[1:]:
                self.assertEqual(line[start - 2:start].strip(), "", line)
        self.assertEqual(len(rows), 3)
        self.assertTrue(any("…" in row for row in rows), "white noise alone identifies no B")

    def test_accept_decides(self) -> None:
        self.assertEqual(self.daemon.get(self.target, Accept="text/plain;q=0.5, text/csv").headers["content-type"].partition(";")[0], "text/csv")
        self.assertEqual(self.daemon.get(self.target, Accept="*/*").headers["content-type"], "application/json")
        self.problem(406, "not_acceptable", self.daemon.get(self.target, Accept="image/png"))
        etag = self.daemon.get(self.target, Accept="text/csv").headers["etag"]
        self.expect(304, self.daemon.get(self.target, Accept="text/csv", If_None_Match=etag))
        self.expect(200, self.daemon.get(self.target, If_None_Match=etag))

    def test_units_that_do_not_convert_are_said_in_document_and_table(self) -> None:
        """A column without a unit beside one in deg/s: the error of pooling was swallowed, and the table averaged the two."""
        recordings = [self.daemon.upload(samples.gyro_csv(4000, seed=seed), device="mixed", condition="static", rate_hz=100, columns=columns).json["id"]
                      for seed, columns in ((204, samples.GYRO_Z), (205, "gz=angular_rate:z"))]
        job = self.daemon.finished(self.daemon.characterise(*recordings, models=["WN", "WN+GM"]).json["id"])
        document = self.expect(200, self.daemon.get(job["result"]["href"])).json
        conflict = "units that do not convert into each other, deg/s and 1."
        self.assertIn(conflict, document["replicates"][0]["reason"])
        self.assertEqual(document["trends"], [])
        for method in ("av", "gmwm"):
            answer = self.daemon.get(f"/v1/parameter-tables?device=mixed&axis=z&method={method}", Prefer="wait=60")
            refused = self.problem(400, "invalid_argument", answer)
            self.assertIn(conflict, str(refused["detail"]))

    def test_faults_name_the_parameter(self) -> None:
        self.problem(400, "invalid_argument", self.daemon.get("/v1/parameter-tables?axis=z"), parameter="device")
        self.problem(404, "not_found", self.daemon.get("/v1/parameter-tables?device=nobody"))
        for extra, parameter in (("&method=ml", "method"), ("&model=WN%2BXX", "model")):
            self.problem(400, "invalid_argument", self.daemon.get(self.target + extra), parameter=parameter)
        base = self.target.partition("&sensor")[0]
        unnamed = self.problem(400, "invalid_argument", self.daemon.get(f"{base}&sensor=gyroscope"), parameter="axis")
        self.assertIn("about z", str(unnamed["detail"]))
        self.problem(400, "invalid_argument", self.daemon.get(f"{base}&axis=w"), parameter="axis")
        self.assertEqual(self.daemon.get(f"{base}&sensor=barometer&axis=z").json["where"]["parameter"], "sensor")
        self.problem(404, "not_found", self.daemon.get(f"{base}&sensor=accelerometer&axis=z"))


if __name__ == "__main__":
    unittest.main()
