"""The templates in deploy/ci as a pipeline runs them: each gates, posts its summary, and works with a daemon and without."""
from __future__ import annotations

import json
import os
import re
import subprocess
import tempfile
import threading
import unittest
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import ClassVar
from urllib.parse import parse_qs

import yaml
from daemon import Daemon
from firmware import gyroscope

PROGRAM = os.environ["DRIFTLAB"]
DEPLOY = Path(__file__).resolve().parents[2] / "deploy/ci"
PATIENCE_S = 300


class Notes(BaseHTTPRequestHandler):
    """Where a template posts the note of a merge request."""
    posted: ClassVar[list[tuple[str, str, str]]] = []

    def do_POST(self) -> None:
        body = self.rfile.read(int(self.headers["Content-Length"])).decode()
        self.posted.append((self.path, self.headers["PRIVATE-TOKEN"], parse_qs(body)["body"][0]))
        self.send_response(201)
        self.end_headers()

    def log_message(self, *_: object) -> None:
        pass


class Templates(unittest.TestCase):
    """Each template's steps, run in a shell in a repository like the one that its first lines describe."""
    notes: ThreadingHTTPServer

    @classmethod
    def setUpClass(cls) -> None:
        cls.notes = ThreadingHTTPServer(("127.0.0.1", 0), Notes)
        threading.Thread(target=cls.notes.serve_forever, daemon=True).start()
        cls.addClassCleanup(cls.notes.server_close)
        cls.addClassCleanup(cls.notes.shutdown)

    def steps(self, name: str) -> list[str]:
        text = (DEPLOY / name).read_text()
        if name.startswith("Jenkinsfile"):
            for kept in ("archiveArtifacts 'driftlab-report/**'", "currentBuild.description = sh(", "junit 'driftlab-report/junit.xml'"):
                self.assertIn(kept, text)
            return re.findall(r"script: '([^']+)'", text)
        document = yaml.safe_load(text)
        if name.startswith("gitlab-ci"):
            job = document["sensor-noise"]
            self.assertEqual(job["artifacts"]["reports"]["junit"], "driftlab-report/junit.xml")
            self.assertEqual(job["allow_failure"], {"exit_codes": 3})
            return [*job["script"], *job["after_script"]]
        return [step["run"] for step in document["jobs"]["regress"]["steps"] if "run" in step]

    def posted(self, name: str, repository: Path, last: str) -> str:
        """The summary as the service of that template shows it."""
        if name.startswith("github"):
            return (repository / "posted.md").read_text()
        if name.startswith("Jenkinsfile"):
            return last
        path, token, body = Notes.posted.pop()
        self.assertEqual((path, token), ("/projects/7/merge_requests/3/notes", "glpat"))
        return body

    def run_in(self, repository: Path, name: str, label: str, **more: str) -> tuple[list[int], str, str]:
        environment = {**os.environ, "PATH": f"{Path(PROGRAM).parent}:{os.environ['PATH']}", "GITHUB_STEP_SUMMARY": str(repository / "posted.md"),
                       "GITHUB_SHA": label, "CI_COMMIT_SHORT_SHA": label, "BUILD_NUMBER": label, "CI_MERGE_REQUEST_IID": "3", "CI_PROJECT_ID": "7",
                       "GITLAB_TOKEN": "glpat", "CI_API_V4_URL": f"http://127.0.0.1:{self.notes.server_port}", **more}
        done = [subprocess.run(["bash", "-e", "-c", step], cwd=repository, env=environment, capture_output=True, text=True,
                               timeout=PATIENCE_S, check=False, stdin=subprocess.DEVNULL) for step in self.steps(name)]
        return [each.returncode for each in done], self.posted(name, repository, done[-1].stdout), "\n".join(each.stderr for each in done)

    @staticmethod
    def fill(folder: Path, white: float, scale: float, seed: int = 1) -> None:
        folder.mkdir()
        for session in range(3):
            (folder / f"{session}.csv").write_text(gyroscope(seed + session, white, scale))

    def test_every_template_gates_and_posts_the_summary(self) -> None:
        for name in ("github-actions.yml", "gitlab-ci.yml", "Jenkinsfile"):
            for white, expected in ((0.1, 0), (0.17, 1)):
                with self.subTest(name, white=white), tempfile.TemporaryDirectory(prefix="driftlab-ci-") as folder:
                    repository = Path(folder)
                    self.fill(repository / "baseline", 0.1, 1.0)
                    self.fill(repository / "candidate", white, 1.01)
                    codes, posted, said = self.run_in(repository, name, "abcdef12")
                    self.assertEqual(codes, [expected, 0], said)
                    self.assertTrue(posted.startswith("**PASS**" if expected == 0 else "**FAIL**"), posted)

    def test_every_template_works_against_a_daemon(self) -> None:
        with Daemon() as daemon, tempfile.TemporaryDirectory(prefix="driftlab-ci-") as folder:
            server = f"http://127.0.0.1:{daemon.port}"
            old = Path(folder) / "old"
            self.fill(old, 0.1, 1.0)
            self.fill(Path(folder) / "first", 0.1, 1.005)
            begun = subprocess.run([PROGRAM, "ci", "--server", server, "--device", "imu-07", "--baseline", *map(str, sorted(old.iterdir())),
                                    "--baseline-label", "firmware=1.0", "--candidate", *map(str, sorted((Path(folder) / "first").iterdir())),
                                    "--candidate-label", "firmware=1.1"], cwd=folder, capture_output=True, text=True, timeout=PATIENCE_S, check=False)
            self.assertIn(begun.returncode, (0, 3), begun.stderr)
            for number, name in enumerate(("github-actions-server.yml", "gitlab-ci-server.yml", "Jenkinsfile-server")):
                with self.subTest(name):
                    repository = Path(folder) / name
                    repository.mkdir()
                    self.fill(repository / "candidate", 0.17, 1.0, 40 + 10 * number)
                    codes, posted, said = self.run_in(repository, name, f"abcdef1{number}", DRIFTLAB_SERVER=server, DRIFTLAB_DEVICE="imu-07")
                    self.assertEqual(codes, [1, 0], said)
                    self.assertTrue(posted.startswith("**FAIL**"), posted)

    def test_every_template_works_on_the_next_commit_with_the_same_recordings(self) -> None:
        """Recordings lie in the repository, labels are those of commits: what the daemon has of an earlier one is compared as it is."""
        with Daemon() as daemon, tempfile.TemporaryDirectory(prefix="driftlab-ci-") as folder:
            server = f"http://127.0.0.1:{daemon.port}"
            for number, name in enumerate(("github-actions-server.yml", "gitlab-ci-server.yml", "Jenkinsfile-server")):
                with self.subTest(name):
                    repository, device = Path(folder) / name, f"imu-{number}"
                    repository.mkdir()
                    self.fill(repository / "old", 0.1, 1.0)
                    self.fill(repository / "candidate", 0.1, 1.01)
                    there = {"DRIFTLAB_SERVER": server, "DRIFTLAB_DEVICE": device}
                    old, new = ([str(path) for path in sorted((repository / arm).iterdir())] for arm in ("old", "candidate"))
                    begun = subprocess.run([PROGRAM, "ci", "--server", server, "--device", device, "--baseline", *old,
                                            "--baseline-label", "firmware=1.0", "--candidate", *new, "--candidate-label", "firmware=aaaa0000"],
                                           cwd=repository, capture_output=True, text=True, timeout=PATIENCE_S, check=False)
                    self.assertEqual(begun.returncode, 0, begun.stderr)
                    first = json.loads((repository / "driftlab-report/regression.json").read_text())
                    codes, posted, said = self.run_in(repository, name, "bbbb0000", **there)
                    self.assertEqual(codes, [0, 0], said)
                    self.assertTrue(posted.startswith("**PASS**"), posted)
                    self.assertIn("candidate: the bytes of 3 files are stored already under firmware=aaaa0000 and are compared as they are.", said)
                    again = json.loads((repository / "driftlab-report/regression.json").read_text())
                    self.assertEqual((again["look"], again["units"], again["arms"]), (first["look"], first["units"], first["arms"]), "the same look")
                    self.assertEqual(len(daemon.items(f"/v1/recordings?device={device}&labels=firmware=aaaa0000")), 3, "labels stay")
                    # One more power-up: the arm goes by the new label, and by it again when nothing more comes.
                    (repository / "candidate/3.csv").write_text(gyroscope(9, 0.1, 1.01))
                    for label, told in (("cccc0000", "3 of 4 files are stored already under firmware=aaaa0000"),
                                        ("dddd0000", "1 of 4 files are stored already under firmware=cccc0000")):
                        codes, _, said = self.run_in(repository, name, label, **there)
                        self.assertIn(codes[0], (0, 3), said)
                        self.assertIn(told, said)
                        grown = json.loads((repository / "driftlab-report/regression.json").read_text())
                        self.assertEqual((grown["arms"]["candidate"]["label"], len(grown["arms"]["candidate"]["sessions"]), grown["look"]["number"]),
                                         ("firmware=cccc0000", 4, 1))

    def test_only_other_labels_are_compared_as_they_are(self) -> None:
        with Daemon() as daemon, tempfile.TemporaryDirectory(prefix="driftlab-ci-") as folder:
            repository = Path(folder)
            self.fill(repository / "old", 0.1, 1.0)
            self.fill(repository / "candidate", 0.1, 1.01)
            files = {arm: [str(path) for path in sorted((repository / arm).iterdir())] for arm in ("old", "candidate")}

            def run(*arguments: str) -> tuple[int, str]:
                server = ("--server", f"http://127.0.0.1:{daemon.port}", "--device", "imu-07")
                done = subprocess.run([PROGRAM, "ci", *server, *arguments], cwd=repository,
                                      capture_output=True, text=True, timeout=PATIENCE_S, check=False)
                return done.returncode, done.stderr
            code, said = run("--baseline", *files["old"], "--baseline-label", "firmware=1.0",
                             "--candidate", *files["candidate"], "--candidate-label", "firmware=aaaa")
            self.assertEqual(code, 0, said)
            code, said = run("--candidate", *files["candidate"], "--candidate-label", "firmware=bbbb", "--condition", "constant_rate:z:9:deg/s")
            self.assertEqual(code, 2, "another condition is another recording")
            self.assertIn("with other metadata; change those with PATCH", said)
            code, said = run("--candidate", files["old"][0], *files["candidate"][1:], "--candidate-label", "firmware=cccc")
            self.assertEqual(code, 2, said)
            self.assertIn("is in both arms", said)

    def test_an_undecided_run_is_no_failure(self) -> None:
        for name in ("github-actions.yml", "gitlab-ci.yml", "Jenkinsfile"):
            with self.subTest(name), tempfile.TemporaryDirectory(prefix="driftlab-ci-") as folder:
                repository = Path(folder)
                for arm in ("baseline", "candidate"):
                    (repository / arm).mkdir()
                    (repository / arm / "0.csv").write_text(gyroscope(1, 0.1, 1.0 if arm == "baseline" else 1.01))
                codes, posted, said = self.run_in(repository, name, "abcdef12")
                self.assertEqual(codes, [0 if name.startswith("github") else 3, 0], said)
                self.assertTrue(posted.startswith("**INCONCLUSIVE**"), posted)
                self.assertIn("ndecided", (DEPLOY / name).read_text())

    def test_github_hands_the_token_over(self) -> None:
        environment = yaml.safe_load((DEPLOY / "github-actions-server.yml").read_text())["env"]
        self.assertEqual(environment["DRIFTLAB_TOKEN"], "${{ secrets.DRIFTLAB_TOKEN }}")

    def test_templates_are_ten_lines_at_most(self) -> None:
        names = sorted(path.name for path in DEPLOY.iterdir())
        self.assertEqual(len(names), 6, "each of the three with and without a server")
        for name in names:
            lines = [line for line in (DEPLOY / name).read_text().splitlines() if not line.startswith(("#", "//"))]
            self.assertLessEqual(len(lines), 10, name)


if __name__ == "__main__":
    unittest.main()
