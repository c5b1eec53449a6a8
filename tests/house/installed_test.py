#!/usr/bin/env python3
"""What is installed works where it was put: the Debian package, unpacked into a folder, does driftlab's main job.

The manual and the completions say what --help says. Nothing here needs root.
"""
from __future__ import annotations

import json
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[2]
PROGRAMS = Path(os.environ.get("DRIFTLAB_BIN") or REPOSITORY / "build/release/bin").resolve()
BUILD = PROGRAMS.parent
CLEAN = {name: value for name, value in os.environ.items() if not name.startswith("DRIFTLAB_")}
sys.path.insert(0, str(Path(__file__).resolve().parent))

from documents import help_of, subcommands_of  # noqa: E402


def output_of(*words: str | Path, code: int = 0) -> str:
    ran = subprocess.run([str(word) for word in words], capture_output=True, text=True, check=False, timeout=280, env=CLEAN)
    assert ran.returncode == code, f"{words}: {ran.returncode} {ran.stdout[-2000:]}{ran.stderr[-2000:]}"
    return ran.stdout


def commands_of(program: str) -> list[tuple[str, ...]]:
    paths: list[tuple[str, ...]] = [()]
    for path in paths:  # grows while it is walked
        paths += [(*path, name) for name in subcommands_of(PROGRAMS / program, *path)]
    return paths


def flags_of(program: str, path: tuple[str, ...]) -> set[str]:
    options = help_of(PROGRAMS / program, *path).split("Options:")[-1].split("Subcommands:")[0]
    return set(re.findall(r"^  (?:-\w,)?(--[a-z][\w-]*)", options, re.MULTILINE))


class Manuals(unittest.TestCase):
    def test_the_manual_has_every_command_and_flag_and_is_sound_troff(self) -> None:
        for program in ("driftlab", "driftlabd"):
            page = output_of(PROGRAMS / program, "man")
            plain = page.replace("\\-", "-").replace("\\fB", "").replace("\\fR", "").replace("\\fI", "").replace("\\&", "")
            for path in commands_of(program):
                self.assertIn(f"\n.SS {' '.join((program, *path))}\n" if path else "\n.SH NAME\n", plain)
                for flag in flags_of(program, path):
                    self.assertRegex(plain, re.escape(flag) + r"(?![\w-])", f"{program} {path}")
            if shutil.which("groff"):
                ran = subprocess.run(["groff", "-man", "-ww", "-z"], input=page, capture_output=True, text=True, check=False)
                self.assertEqual((ran.returncode, ran.stderr), (0, ""))
            self.assertEqual(page, output_of(PROGRAMS / program, "man"), "equal programs give equal pages")

    def completed(self, program: str, *words: str) -> set[str]:
        script = (f'source <("{PROGRAMS / program}" completion bash); COMP_WORDS=({" ".join(words)} ""); '
                  'COMP_WORDS[-1]="$LAST"; COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _' + program + '; printf "%s\\n" "${COMPREPLY[@]}"')
        ran = subprocess.run(["bash", "--norc", "-c", script], capture_output=True, text=True, check=True, env={**CLEAN, "LAST": self.last})
        return set(ran.stdout.split())

    def test_bash_completes_what_help_lists(self) -> None:
        for program in ("driftlab", "driftlabd"):
            for path in commands_of(program):
                self.last = "--"
                offered = self.completed(program, program, *path)
                self.assertLessEqual(flags_of(program, path), offered, f"{program} {path}")
                self.last = ""
                self.assertEqual(self.completed(program, program, *path), set(subcommands_of(PROGRAMS / program, *path)), f"{program} {path}")
        self.last = "m"
        self.assertEqual(self.completed("driftlab", "driftlab", "table", "--format"), {"markdown"})
        self.last = "--f"
        self.assertEqual(self.completed("driftlab", "driftlab", "table"), {"--format"})
        self.last = ""
        self.assertEqual(self.completed("driftlab", "driftlab", "plot", "--out"), set(), "files are the shell's own")

    def test_the_other_shells_take_their_scripts(self) -> None:
        for shell, check in (("zsh", ("zsh", "-n")), ("fish", ("fish", "--no-execute"))):
            script = output_of(PROGRAMS / "driftlab", "completion", shell)
            self.assertIn("characterise", script)
            if shutil.which(shell):  # ./tests/run.sh installs both
                with tempfile.NamedTemporaryFile("w", suffix=f".{shell}") as file:
                    file.write(script)
                    file.flush()
                    output_of(*check, file.name)
        if shutil.which("fish"):
            for typed, offered in (("driftlab charac", {"characterise"}), ("driftlab table --for", {"--format"}), ("driftlab table --format m", {"markdown"})):
                fish = f'{PROGRAMS / "driftlab"} completion fish | source; complete -C"{typed}"'
                ran = subprocess.run(["fish", "--no-config", "-c", fish], capture_output=True, text=True, check=True, cwd="/", env={**CLEAN, "HOME": "/nonexistent"})
                self.assertEqual({line.split("\t")[0] for line in ran.stdout.splitlines()}, offered, typed)
        ran = subprocess.run([PROGRAMS / "driftlab", "completion", "csh"], capture_output=True, text=True, check=False)
        self.assertEqual(ran.returncode, 2)


class Package(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        if not shutil.which("dpkg-deb") or not shutil.which("cpack"):
            raise unittest.SkipTest("SKIPPED: there is no dpkg-deb or no cpack here")
        cls.folder = Path(cls.enterClassContext(tempfile.TemporaryDirectory()))  # type: ignore[arg-type]
        output_of("cpack", "-G", "DEB", "--config", BUILD / "CPackConfig.cmake", "-B", cls.folder / "made")
        [cls.package] = (cls.folder / "made").glob("driftlab_*.deb")
        cls.root = cls.folder / "root"
        output_of("dpkg-deb", "-x", cls.package, cls.root)

    def test_everything_has_its_place(self) -> None:
        files = {path.relative_to(self.root).as_posix() for path in self.root.rglob("*") if path.is_file()}
        wanted = {"usr/bin/driftlab", "usr/bin/driftlabd", "usr/bin/driftlab-decode", "usr/share/man/man1/driftlab.1", "usr/share/man/man8/driftlabd.8",
                  "usr/share/bash-completion/completions/driftlab", "usr/share/bash-completion/completions/driftlabd",
                  "usr/share/zsh/vendor-completions/_driftlab", "usr/share/fish/vendor_completions.d/driftlab.fish",
                  "usr/lib/systemd/system/driftlabd.service", "usr/share/doc/driftlab/copyright", "usr/share/doc/driftlab/manual/cli.md",
                  "usr/share/doc/driftlab/examples/grafana/driftlab.json", "usr/share/doc/driftlab/examples/prometheus/driftlab.rules.yml"}
        self.assertEqual(wanted - files, set())
        self.assertTrue(all(name.startswith("usr/") for name in files), sorted(files))
        for name in files:
            self.assertNotIn(str(REPOSITORY).encode(), (self.root / name).read_bytes(), f"{name} names the folder it was built in")

    def test_the_unit_starts_the_program_that_was_installed(self) -> None:
        unit = (self.root / "usr/lib/systemd/system/driftlabd.service").read_text()
        self.assertIn("\nExecStart=/usr/bin/driftlabd --data /var/lib/driftlab\n", unit)
        source = (REPOSITORY / "deploy/systemd/driftlabd.service").read_text()
        self.assertEqual([line for line in unit.splitlines() if "=" in line and not line.startswith(("#", "ExecStart="))],
                         [line for line in source.splitlines() if "=" in line and not line.startswith(("#", "ExecStart="))])

    def test_the_package_says_what_it_needs(self) -> None:
        control = output_of("dpkg-deb", "-f", self.package)
        needs = re.search(r"^Depends: (.*)$", control, re.MULTILINE)
        assert needs
        runtime = output_of(REPOSITORY / "deploy/packages.sh", "runtime").split()
        self.assertLessEqual(set(runtime), set(needs.group(1).split(", ")))
        self.assertIn("\nPackage: driftlab\n", "\n" + control)

    def test_it_does_the_main_job_from_where_it_was_put(self) -> None:
        driftlab, driftlabd = self.root / "usr/bin/driftlab", self.root / "usr/bin/driftlabd"
        recording = self.folder / "recording.csv"
        output_of(driftlab, "simulate", "--preset", "iphone5s-z", "--duration-s", "300", "--out", recording)
        local = json.loads(output_of(driftlab, "characterise", recording, "--json", "--models", "WN,WN+GM"))
        self.assertTrue(local["recordings"][0]["channels"])
        words = [str(driftlabd), "--data", str(self.folder / "data"), "--listen", "127.0.0.1:0"]
        daemon = subprocess.Popen(words, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, env=CLEAN)
        try:
            assert daemon.stderr is not None
            port = 0
            for line in daemon.stderr:
                if '"listening"' in line:
                    port = int(re.search(r'"port": ?(\d+)', line).group(1))  # type: ignore[union-attr]
                    break
            server = f"http://127.0.0.1:{port}"
            there = output_of(driftlab, "characterise", recording, "--server", server, "--device", "phone-07", "--models", "WN,WN+GM")
            self.assertIn("GMWM", there)
            self.assertIn("static", output_of(driftlab, "table", "--server", server, "--device", "phone-07", "--sensor", "gyroscope", "--axis", "z"))
        finally:
            daemon.send_signal(signal.SIGTERM)
            self.assertEqual(daemon.wait(60), 0)
            daemon.stderr.close()  # type: ignore[union-attr]

    def test_install_puts_the_same_under_any_prefix(self) -> None:
        prefix = self.folder / "opt"
        output_of("cmake", "--install", BUILD, "--prefix", prefix)
        self.assertIn(f"ExecStart={prefix}/bin/driftlabd ", (prefix / "lib/systemd/system/driftlabd.service").read_text())
        self.assertIn("driftlab 0.", output_of(prefix / "bin/driftlab", "--version"))
        packed = {path.relative_to(self.root / "usr") for path in self.root.rglob("*") if path.is_file()}
        self.assertEqual({path.relative_to(prefix) for path in prefix.rglob("*") if path.is_file()}, packed)


if __name__ == "__main__":
    unittest.main()
