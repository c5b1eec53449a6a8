"""What the suites share: a daemon for each class, and the contract as the judge of every answer it gives."""
from __future__ import annotations

import unittest

from contract import Contract
from daemon import Answer, Daemon

# How a suite ends that has nothing to run on; ctest then shows it as skipped.
SKIPPED = 77


class DaemonTest(unittest.TestCase):
    """One daemon for the tests of a class; every answer got through it is held to the contract."""

    arguments: tuple[str, ...] = ()
    daemon: Daemon
    contract: Contract

    @classmethod
    def setUpClass(cls) -> None:
        cls.daemon = cls.enterClassContext(Daemon(arguments=cls.arguments))
        cls.contract = Contract.served(cls.daemon)
        cls.daemon.checks.append(cls.contract.judge)

    def expect(self, status: int, answer: Answer) -> Answer:
        self.assertEqual(answer.status, status, answer.describe())
        return answer

    def problem(self, status: int, code: str, answer: Answer, **where: object) -> dict[str, object]:
        """The document of a problem that names `where` what is at fault."""
        self.expect(status, answer)
        document = answer.json
        self.assertEqual(document["code"], code, answer.describe())
        for name, value in where.items():
            self.assertEqual(document.get("where", {}).get(name), value, answer.describe())
        return document
