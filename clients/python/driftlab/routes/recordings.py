"""Devices and their recordings."""
from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, Literal, cast

from ..contract import Condition, Device, DeviceChange, DeviceSummary, Histogram, RecordingChange, RecordingCharacterisation
from ..contract import RecordingPreview, Spectrogram, Spectrum, StoredRecording, Trace
from ..problems import Problem
from ..transport import Body
from ..uploads import Columns, Progress, Source, Upload, columns_text, condition_query, tag_query
from .base import PAGE, SortByName, given, operation
from .uploads import UploadRoutes

DOWNLOADED = 8 << 20  # bytes of a file that are asked for at once


class RecordingRoutes(UploadRoutes):
    resumable_from = 64 << 20  # bytes from which an upload goes in pieces

    @operation("listDevices")
    def devices(self, *, include: Literal["summary"] | None = None, q: str | None = None, sort: SortByName | None = None,
                page_size: int = PAGE) -> Iterator[Device]:
        """Every device, or those that hold `q`, oldest first unless sorted otherwise; with `include` each with its summary."""
        return self._list("listDevices", {"include": include, "q": q, "sort": sort}, page_size)

    @operation("createDevice")
    def create_device(self, name: str, *, model: str | None = None, imu: str | None = None, serial: str | None = None,
                      labels: Mapping[str, str] | None = None, idempotency_key: str | None = None) -> Device:
        """Makes a device known, or gives the one that has these very properties; Conflict where it has others."""
        body = given(name=name, model=model, imu=imu, serial=serial, labels=labels)
        return cast(Device, self._post("createDevice", body, idempotency_key))

    @operation("getDevice")
    def device(self, id: str) -> Device:
        """One device by id or name."""
        return cast(Device, self._get("getDevice", {"id": id}))

    @operation("search")
    def search(self, q: str, *, limit: int | None = None) -> list[dict[str, str]]:
        """What a few letters may mean: devices, recordings, models and investigations, and the beginning of an id; the best first."""
        return cast("list[dict[str, str]]", self._get("search", None, {"q": q, "limit": limit})["items"])

    @operation("getDeviceSummary")
    def device_summary(self, id: str) -> DeviceSummary:
        """A device at a glance: recordings, conditions, white noise of each axis."""
        return cast(DeviceSummary, self._get("getDeviceSummary", {"id": id}))

    def device_etag(self, id: str) -> str:
        """Names the state of a device, for `if_match`."""
        return self._etag("getDevice", {"id": id})

    @operation("changeDevice")
    def change_device(self, id: str, change: DeviceChange, *, if_match: str = "*") -> Device:
        """Replaces the members given. With an ETag as `if_match` only where the device is still as it was read: else Conflict."""
        answer = self._transport.call("changeDevice", {"id": id}, body=Body.of_json(change), if_match=if_match)
        return cast(Device, answer.json)

    @operation("deleteDevice")
    def delete_device(self, id: str, *, if_match: str = "*") -> None:
        """Deletes a device; Conflict names what depends on it."""
        self._transport.call("deleteDevice", {"id": id}, if_match=if_match)

    @operation("listRecordings")
    def recordings(self, *, device: str | None = None, condition: str | None = None, labels: Mapping[str, str] | None = None,
                   q: str | None = None, since: str | None = None, has_result: bool | None = None, sort: SortByName | None = None,
                   page_size: int = PAGE) -> Iterator[StoredRecording]:
        """Recordings, oldest first unless sorted otherwise: those that have all labels, whose name, file, condition or id holds `q`,
        that were made at `since` (RFC 3339) or later, that were characterised or not. `condition` is in its compact form, for example
        constant_rate:z:9:deg/s.
        """
        query = {"device": device, "condition": condition, "labels": tag_query(labels, None, None)["labels"], "q": q, "since": since,
                 "has_result": None if has_result is None else str(has_result).lower(), "sort": sort}
        return self._list("listRecordings", query, page_size)

    @operation("getCharacterisation")
    def characterisation(self, id: str, *, channel: str | None = None) -> RecordingCharacterisation:
        """The newest result of a recording, with its verdict and what its best fit implies; NotFound before there is one."""
        return cast(RecordingCharacterisation, self._get("getCharacterisation", {"id": id}, {"channel": channel}))

    @operation("getTrace")
    def trace(self, id: str, channel: str, *, t0: float | None = None, t1: float | None = None, points: int | None = None) -> Trace:
        """A column as a screen can show it: least, greatest and mean value of every stretch between two times [s]."""
        return cast(Trace, self._get("getTrace", {"id": id}, {"channel": channel, "t0": t0, "t1": t1, "points": points}))

    @operation("getSpectrum")
    def spectrum(self, id: str, channel: str, *, scale: Literal["log", "linear"] | None = None, points: int | None = None) -> Spectrum:
        """Two-sided power spectral density of a channel, in bins of equal width on the scale asked for."""
        return cast(Spectrum, self._get("getSpectrum", {"id": id}, {"channel": channel, "scale": scale, "points": points}))

    @operation("getHistogram")
    def histogram(self, id: str, channel: str, *, bins: int | None = None) -> Histogram:
        """How the values of a channel are distributed, in robust standard deviations from the median."""
        return cast(Histogram, self._get("getHistogram", {"id": id}, {"channel": channel, "bins": bins}))

    @operation("getSpectrogram")
    def spectrogram(self, id: str, channel: str, *, times: int | None = None, bands: int | None = None,
                    fit: str | None = None) -> Spectrogram:
        """The density in time and frequency over that of a fit, or over the median in time of each frequency."""
        query = {"channel": channel, "times": times, "bands": bands, "fit": fit}
        return cast(Spectrogram, self._get("getSpectrogram", {"id": id}, query))

    @operation("getSample")
    def sample(self, preset: str = "iphone5s-z", *, condition: str | None = None, seed: int | None = None) -> str:
        """A recording to try driftlab with, as CSV: simulated from published figures."""
        return self._text("getSample", "text/csv", {"preset": preset}, {"condition": condition, "seed": seed})

    @operation("previewRecording")
    def preview(self, beginning: bytes, *, file_bytes: int | None = None, device: str | None = None, condition: str | None = None,
                rate_hz: float | None = None, columns: Columns | None = None, idempotency_key: str | None = None) -> RecordingPreview:
        """What a file would be as a recording, by its first bytes (1 MiB at most): columns, rate, condition, problems. Keeps nothing.

        `file_bytes` is the size of the whole file; without it the bytes are taken for the beginning of a longer one.
        """
        query = {"device": device, "rate_hz": rate_hz, "columns": columns_text(columns), "condition": condition}
        body = Body(len(beginning), "application/octet-stream", lambda: [beginning])
        headers = {} if file_bytes is None else {"Content-Range": f"bytes 0-{len(beginning) - 1}/{file_bytes}"}
        answer = self._transport.call("previewRecording", query=query, body=body, headers=headers, idempotency_key=idempotency_key)
        return cast(RecordingPreview, answer.json)

    @operation("uploadRecording")
    def upload(self, source: Source, *, device: str, condition: str | Condition = "static", rate_hz: float | None = None,
               columns: Columns | None = None, stream: str | None = None, id: str | None = None, trim_start_s: float | None = None,
               trim_end_s: float | None = None,
               calibration: str | None = None, axis: str | None = None, value: float | None = None, unit: str | None = None,
               direction: str | None = None, labels: Mapping[str, str] | None = None, session: str | None = None,
               recorded_at: str | None = None, file_name: str | None = None, progress: Progress | None = None,
               idempotency_key: str | None = None) -> StoredRecording:
        """Uploads a file, bytes, or an array whose rows are samples, and says what it is. Queues no job.

        columns and condition are given as in the manual (gz=angular_rate:z:deg/s; constant_rate:z:9:deg/s) or as documents; axis,
        value, unit and direction stand beside a condition of which only the kind is given. Labels, session and recorded_at (RFC 3339)
        are what regression runs compare by. `file_name` is shown beside the recording; of a path it is known. `progress` is called with
        the bytes sent and the bytes in all. An upload that the network cuts off is sent again under the same Idempotency-Key; the daemon
        checks the digest, and stores the recording once. One of 64 MiB or more goes in pieces that are kept as they arrive, so that a
        broken connection costs one piece.
        """
        upload = Upload(source, progress)
        if upload.size >= self.resumable_from:
            return self.record_upload(self._sent_in_pieces(upload), device=device, condition=condition, rate_hz=rate_hz, columns=columns,
                                      stream=stream, name=id, trim_start_s=trim_start_s, trim_end_s=trim_end_s, calibration=calibration,
                                      axis=axis, value=value, unit=unit, direction=direction, labels=labels, session=session,
                                      recorded_at=recorded_at, file_name=file_name or upload.name, idempotency_key=idempotency_key)
        query: dict[str, Any] = {"device": device, "id": id, "rate_hz": rate_hz, "columns": columns_text(columns), "stream": stream,
                                 "trim_start_s": trim_start_s, "trim_end_s": trim_end_s, "calibration": calibration, "axis": axis,
                                 "value": value, "unit": unit, "direction": direction,
                                 "file_name": file_name or upload.name, **condition_query(condition),
                                 **tag_query(labels, session, recorded_at)}
        answer = self._transport.call("uploadRecording", None, query, upload.body(), idempotency_key=idempotency_key,
                                      headers={"Repr-Digest": upload.digest})
        return cast(StoredRecording, answer.json)

    def _sent_in_pieces(self, upload: Upload) -> str:
        """The id of the complete upload. What became of a piece whose answer was lost is asked; it is sent again if it did not arrive."""
        id = self.create_upload(upload.size)["id"]
        for offset, piece in upload.large_pieces():
            for attempt in range(self._transport.retry.attempts):
                try:
                    self.append_to_upload(id, offset, piece)
                    break
                except Problem as problem:
                    lost = problem.retryable or problem.status == 409
                    if not lost or attempt + 1 == self._transport.retry.attempts:
                        raise
                    self._transport.retry.sleep(self._transport.retry.pause(attempt, problem.retry_after))
                    if self.upload_state(id)["offset"] == offset + len(piece):
                        break
            upload.tell(offset + len(piece))
        return id

    @operation("getRecording")
    def recording(self, id: str) -> StoredRecording:
        """One recording with its metadata, quality and file."""
        return cast(StoredRecording, self._get("getRecording", {"id": id}))

    def recording_etag(self, id: str) -> str:
        """Names the state of a recording, for `if_match`."""
        return self._etag("getRecording", {"id": id})

    @operation("getRecordingContent")
    def content(self, id: str, *, first: int | None = None, last: int | None = None) -> bytes:
        """The uploaded file, or its bytes from `first` to `last`, both included, from 0."""
        wanted = {} if first is None and last is None else {"Range": f"bytes={first or 0}-{'' if last is None else last}"}
        return self._transport.call("getRecordingContent", {"id": id}, accept="*/*", headers=wanted).content

    def download(self, id: str, target: str | Path, *, progress: Progress | None = None) -> None:
        """Writes the uploaded file to `target` piece by piece; what a broken connection left is asked for again, not the whole."""
        size = self.recording(id)["file"]["bytes"]
        with open(target, "wb") as file:
            for first in range(0, size, DOWNLOADED):
                file.write(self.content(id, first=first, last=min(first + DOWNLOADED, size) - 1))
                if progress is not None:
                    progress(file.tell(), size)

    @operation("changeRecording")
    def change_recording(self, id: str, change: RecordingChange, *, if_match: str = "*") -> StoredRecording:
        """Replaces members of the metadata; None removes one. The change makes a revision."""
        answer = self._transport.call("changeRecording", {"id": id}, body=Body.of_json(change), if_match=if_match)
        return cast(StoredRecording, answer.json)

    @operation("deleteRecording")
    def delete_recording(self, id: str, *, if_match: str = "*") -> None:
        """Deletes a recording and its results."""
        self._transport.call("deleteRecording", {"id": id}, if_match=if_match)
