"""Uploads that may stop and go on, and recordings that are still being made."""
from __future__ import annotations

import base64
import hashlib
import json
from collections.abc import Iterator, Mapping
from typing import Any, cast

from ..contract import Condition, LiveRecording, NewLiveRecording, StoredRecording, Upload
from ..transport import Body
from ..uploads import Columns, columns_text, condition_query, tag_query
from .base import Routes, operation

TUS = {"Tus-Resumable": "1.0.0"}


class UploadRoutes(Routes):
    @operation("createUpload")
    def create_upload(self, length: int, *, file_name: str | None = None, idempotency_key: str | None = None) -> Upload:
        """Begins an upload of so many bytes (tus 1.0.0). `upload` does all of it for a file that is large."""
        headers = {**TUS, "Upload-Length": str(length)}
        if file_name:
            headers["Upload-Metadata"] = "filename " + base64.b64encode(file_name.encode()).decode()
        return cast(Upload, self._transport.call("createUpload", headers=headers, idempotency_key=idempotency_key).json)

    @operation("getUpload")
    def upload_state(self, id: str) -> Upload:
        """How far an upload is."""
        return cast(Upload, self._get("getUpload", {"id": id}))

    @operation("appendToUpload")
    def append_to_upload(self, id: str, offset: int, content: bytes) -> int:
        """Adds bytes at the offset at which the upload stands; kept whole, by their checksum, or not at all. The new offset."""
        digest = base64.b64encode(hashlib.sha256(content).digest()).decode()
        headers = {**TUS, "Upload-Offset": str(offset), "Upload-Checksum": f"sha256 {digest}"}
        body = Body(len(content), "application/offset+octet-stream", lambda: iter([content]))
        return int(self._transport.call("appendToUpload", {"id": id}, None, body, headers=headers).headers["upload-offset"])

    @operation("deleteUpload")
    def delete_upload(self, id: str) -> None:
        """Gives an upload up."""
        self._transport.call("deleteUpload", {"id": id}, headers=TUS)

    @operation("recordUpload")
    def record_upload(self, id: str, *, device: str, condition: str | Condition = "static", rate_hz: float | None = None,
                      columns: Columns | None = None, stream: str | None = None, name: str | None = None, trim_start_s: float | None = None,
                      trim_end_s: float | None = None, calibration: str | None = None, axis: str | None = None,
                      value: float | None = None, unit: str | None = None, direction: str | None = None,
                      labels: Mapping[str, str] | None = None, session: str | None = None, recorded_at: str | None = None,
                      file_name: str | None = None, idempotency_key: str | None = None) -> StoredRecording:
        """Makes a recording of a complete upload, which `name` names; the rest is as in `upload`. Refused, the upload stays."""
        query: dict[str, Any] = {"device": device, "id": name, "rate_hz": rate_hz, "columns": columns_text(columns), "stream": stream,
                                 "trim_start_s": trim_start_s, "trim_end_s": trim_end_s, "calibration": calibration, "axis": axis,
                                 "value": value, "unit": unit, "direction": direction, "file_name": file_name, **condition_query(condition),
                                 **tag_query(labels, session, recorded_at)}
        return cast(StoredRecording, self._transport.call("recordUpload", {"id": id}, query, idempotency_key=idempotency_key).json)

    @operation("createLiveRecording")
    def create_live_recording(self, recording: NewLiveRecording, *, idempotency_key: str | None = None) -> LiveRecording:
        """Begins a recording whose samples come while it is made. The answer holds its token, once."""
        return cast(LiveRecording, self._post("createLiveRecording", recording, idempotency_key))

    @operation("getLiveRecording")
    def live_recording(self, id: str) -> LiveRecording:
        """What a live recording is and how much of it came."""
        return cast(LiveRecording, self._get("getLiveRecording", {"id": id}))

    @operation("addLiveSamples")
    def add_live_samples(self, id: str, token: str, sequence: int, rows: bytes, *, idempotency_key: str | None = None) -> None:
        """Adds rows of a float64 time [s] and a float32 for each column, little-endian. The same number again changes nothing."""
        body = Body(len(rows), "application/octet-stream", lambda: iter([rows]))
        self._transport.call("addLiveSamples", {"id": id}, {"sequence": sequence}, body, headers={"Live-Token": token},
                             idempotency_key=idempotency_key)

    @operation("finishLiveRecording")
    def finish_live_recording(self, id: str, token: str, *, idempotency_key: str | None = None) -> dict[str, Any]:
        """Makes a recording of a live one; `recording`, and the `job` that characterises it."""
        answer = self._transport.call("finishLiveRecording", {"id": id}, headers={"Live-Token": token},
                                      idempotency_key=idempotency_key)
        return cast("dict[str, Any]", answer.json)

    @operation("streamLiveRecording")
    def live_growth(self, id: str, *, channel: str | None = None) -> Iterator[dict[str, Any]]:
        """What a live recording says so far, every two seconds at most, until it is finished."""
        kind, data = "", ""
        for line in self._transport.lines("streamLiveRecording", {"id": id}, {}, {"channel": channel}):
            name, _, value = line.partition(":")
            if name == "event":
                kind = value.strip()
            elif name == "data":
                data += value.removeprefix(" ")
            elif not line and data:
                if kind == "finished":
                    return
                yield cast("dict[str, Any]", json.loads(data))
                data = ""
