"""Webhooks: who is told when jobs end."""
from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import cast

from ..contract import IssuedWebhook, Webhook, WebhookDelivery
from ..transport import Body
from .base import PAGE, Routes, given, operation


class WebhookRoutes(Routes):
    @operation("listWebhooks")
    def webhooks(self, *, page_size: int = PAGE) -> Iterator[Webhook]:
        """Every webhook, oldest first, without secrets."""
        return self._list("listWebhooks", {}, page_size)

    @operation("createWebhook")
    def create_webhook(self, url: str, *, events: Sequence[str] | None = None, description: str | None = None) -> IssuedWebhook:
        """Has a receiver told when jobs end; the `secret` that its messages are signed with is told this once."""
        wanted = given(url=url, events=None if events is None else list(events), description=description)
        return cast(IssuedWebhook, self._transport.call("createWebhook", body=Body.of_json(wanted), retries=False).json)

    @operation("getWebhook")
    def webhook(self, id: str) -> Webhook:
        """One webhook, without its secret."""
        return cast(Webhook, self._get("getWebhook", {"id": id}))

    @operation("changeWebhook")
    def change_webhook(self, id: str, *, url: str | None = None, events: Sequence[str] | None = None, description: str | None = None,
                       enabled: bool | None = None, if_match: str = "*") -> Webhook:
        """Changes what is given; `enabled=True` where it was disabled."""
        change = given(url=url, events=None if events is None else list(events), description=description, enabled=enabled)
        return cast(Webhook, self._transport.call("changeWebhook", {"id": id}, body=Body.of_json(change), if_match=if_match).json)

    @operation("deleteWebhook")
    def delete_webhook(self, id: str, *, if_match: str = "*") -> None:
        """Removes a webhook; what waited is not sent."""
        self._transport.call("deleteWebhook", {"id": id}, if_match=if_match)

    @operation("rotateWebhook")
    def rotate_webhook(self, id: str) -> IssuedWebhook:
        """Gives a webhook another secret; for a day both sign."""
        return cast(IssuedWebhook, self._transport.call("rotateWebhook", {"id": id}, retries=False).json)

    @operation("testWebhook")
    def test_webhook(self, id: str, *, idempotency_key: str | None = None) -> WebhookDelivery:
        """Sends a message to try a webhook with."""
        return cast(WebhookDelivery, self._post("testWebhook", None, idempotency_key, {"id": id}))

    @operation("listDeliveries")
    def deliveries(self, id: str, *, state: str | None = None, page_size: int = PAGE) -> Iterator[WebhookDelivery]:
        """What a webhook was told, and what waits."""
        return self._list("listDeliveries", {"state": state}, page_size, {"id": id})
