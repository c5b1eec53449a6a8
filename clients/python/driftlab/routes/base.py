"""What the route classes share: the mark that ties a method to its operation of the contract, and lists page by page."""
from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any, Literal, TypeVar, cast

from ..transport import Body, Query, Transport

Method = TypeVar("Method", bound=Callable[..., Any])
PAGE = 200
Sort = Literal["created_at", "-created_at"]
SortByName = Literal["created_at", "-created_at", "name"]


def operation(name: str) -> Callable[[Method], Method]:
    """Marks the method that is this operation; tests/python/contract_test.py compares marks and contract both ways."""
    def marked(method: Method) -> Method:
        setattr(method, "operation", name)
        return method
    return marked


class Routes:
    """A group of routes over one transport."""

    def __init__(self, transport: Transport) -> None:
        self._transport = transport

    def _get(self, name: str, path: dict[str, str] | None = None, query: Query | None = None, wait_s: float | None = None) -> Any:
        return self._transport.call(name, path, query, accept="application/json", wait_s=wait_s).json

    def _text(self, name: str, media: str, path: dict[str, str] | None = None, query: Query | None = None,
              wait_s: float | None = None) -> str:
        return self._transport.call(name, path, query, accept=media, wait_s=wait_s).content.decode()

    def _post(self, name: str, document: object | None, key: str | None, path: dict[str, str] | None = None,
              wait_s: float | None = None) -> Any:
        body = None if document is None else Body.of_json(document)
        return self._transport.call(name, path, None, body, accept="application/json", idempotency_key=key, wait_s=wait_s).json

    def _etag(self, name: str, path: dict[str, str]) -> str:
        return self._transport.call(name, path, accept="application/json").headers["etag"]

    def _list(self, name: str, query: dict[str, str | None], page_size: int, path: dict[str, str] | None = None) -> Iterator[Any]:
        """Every item, asking for the next page when the one before is used up."""
        cursor: str | None = None
        while True:
            page = cast("dict[str, Any]", self._get(name, path, {**query, "limit": page_size, "cursor": cursor}))
            yield from page["items"]
            cursor = page["next_cursor"]
            if cursor is None:
                return


def given(**members: object) -> dict[str, Any]:
    """The members that are not None."""
    return {name: value for name, value in members.items() if value is not None}
