"""What the suites share: a daemon for each class, and the contract as the judge of every answer it gives."""
from __future__ import annotations

import threading
import time
import unittest
from collections.abc import Callable, Sequence

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

    def is_prompt_beside(self, asked: Sequence[Callable[[], Answer]], status: int) -> None:
        """All of `asked` are under way at once, and /readyz answers ten times before the first of them."""
        ended: list[float] = []
        answers: list[Answer] = []

        def ask(one: Callable[[], Answer]) -> None:
            answers.append(one())
            ended.append(time.monotonic())
        askers = [threading.Thread(target=ask, args=(one,)) for one in asked]
        for each in askers:
            each.start()
        while f"driftlab_http_requests_in_flight {len(asked) + 1}\n" not in self.daemon.get("/metrics").text and not ended:
            pass
        for _ in range(10):  # the first may slip in before they have their threads
            self.expect(200, self.daemon.get("/readyz"))
        answered = time.monotonic()
        for each in askers:
            each.join()
        for answer in answers:
            self.expect(status, answer)
        self.assertLess(answered, min(ended))
