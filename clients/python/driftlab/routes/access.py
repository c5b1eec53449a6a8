"""Tokens, sessions and the audit log: who may do what, and who did what."""
from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import cast

from ..contract import AuditRow, IssuedToken, Scope, Session, Token, VerifyAuditAnswer
from ..transport import Body
from .base import PAGE, Routes, given, operation


class AccessRoutes(Routes):
    @operation("getSession")
    def session(self) -> Session:
        """Who the daemon takes this client for, and what it may do."""
        return cast(Session, self._get("getSession"))

    @operation("openSession")
    def open_session(self, token: str) -> str:
        """Exchanges a token for the cookie of a dashboard; the text of Set-Cookie. Programs need none: they send the token."""
        return self._transport.call("openSession", body=Body.of_json({"token": token}), retries=False).headers["set-cookie"]

    @operation("closeSession")
    def close_session(self, cookie: str) -> None:
        """Ends the session of a cookie, `name=value`."""
        origin = {"Cookie": cookie, "Sec-Fetch-Site": "same-origin"}
        self._transport.call("closeSession", headers=origin)

    @operation("listTokens")
    def tokens(self, *, page_size: int = PAGE) -> Iterator[Token]:
        """Every token that there ever was, oldest first."""
        return self._list("listTokens", {}, page_size)

    @operation("createToken")
    def create_token(self, name: str, scope: Scope, *, devices: Sequence[str] | None = None,
                     expires_in_s: int | None = None) -> IssuedToken:
        """Makes a token; its `secret` is told this once. The first one must be an admin's, and from then on everybody needs one."""
        wanted = given(name=name, scope=scope, devices=None if devices is None else list(devices), expires_in_s=expires_in_s)
        return cast(IssuedToken, self._transport.call("createToken", body=Body.of_json(wanted), retries=False).json)

    @operation("getToken")
    def token(self, id: str) -> Token:
        """One token, without its secret."""
        return cast(Token, self._get("getToken", {"id": id}))

    @operation("rotateToken")
    def rotate_token(self, id: str) -> IssuedToken:
        """Gives a token another secret; the old one ends at once."""
        return cast(IssuedToken, self._transport.call("rotateToken", {"id": id}, retries=False).json)

    @operation("revokeToken")
    def revoke_token(self, id: str, *, idempotency_key: str | None = None) -> Token:
        """Ends a token and its sessions."""
        return cast(Token, self._post("revokeToken", None, idempotency_key, {"id": id}))

    @operation("listAudit")
    def audit(self, *, page_size: int = PAGE) -> Iterator[AuditRow]:
        """What was changed and by whom, oldest first."""
        return self._list("listAudit", {}, page_size)

    @operation("verifyAudit")
    def verify_audit(self) -> VerifyAuditAnswer:
        """Whether the audit log is whole, and the digest of its last row."""
        return cast(VerifyAuditAnswer, self._get("verifyAudit"))
