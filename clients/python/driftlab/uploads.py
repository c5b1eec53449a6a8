"""How a file becomes the body of an upload: read twice, once for its digest, once to be sent; never whole in memory."""
from __future__ import annotations

import base64
import hashlib
import io
import os
from collections.abc import Callable, Iterator, Mapping
from contextlib import AbstractContextManager, nullcontext
from pathlib import Path
from typing import Any, BinaryIO, Union

import numpy

from .contract import Condition, RecordingColumn
from .transport import Body

PIECE = 1 << 18
LARGE_PIECE = 8 << 20
Progress = Callable[[int, int], None]  # bytes sent, bytes in all
Source = Union[str, "os.PathLike[str]", bytes, BinaryIO, "numpy.ndarray[Any, numpy.dtype[Any]]"]
Columns = Union[str, Mapping[str, RecordingColumn]]


def opener_of(source: Source) -> Callable[[], AbstractContextManager[BinaryIO]]:
    """What opens the bytes anew, from their beginning. An array is the .npy file of it: rows are samples.

    A stream is read from where it stands, and left open; one that cannot go back is read into memory.
    """
    if isinstance(source, (str, os.PathLike)):
        path = Path(source)
        return lambda: path.open("rb")
    if isinstance(source, numpy.ndarray):
        made = io.BytesIO()
        numpy.save(made, source if source.dtype == numpy.float32 else source.astype("<f8"), allow_pickle=False)
        content = made.getvalue()
        return lambda: io.BytesIO(content)
    if isinstance(source, bytes):
        whole = source
        return lambda: io.BytesIO(whole)
    stream = source if source.seekable() else io.BytesIO(source.read())
    start = stream.tell()

    def rewound() -> AbstractContextManager[BinaryIO]:
        stream.seek(start)
        return nullcontext(stream)
    return rewound


class Upload:
    """The bytes of one recording, their size and digest. An upload that was cut off is sent again from its beginning."""

    def __init__(self, source: Source, progress: Progress | None = None) -> None:
        self._open, self._progress = opener_of(source), progress
        self.name = Path(source).name if isinstance(source, (str, os.PathLike)) else None
        digest, self.size = hashlib.sha256(), 0
        with self._open() as file:
            while piece := file.read(PIECE):
                digest.update(piece)
                self.size += len(piece)
        self.digest = "sha-256=:" + base64.b64encode(digest.digest()).decode() + ":"

    def body(self) -> Body:
        return Body(self.size, "application/octet-stream", self._pieces)

    def large_pieces(self) -> Iterator[tuple[int, bytes]]:
        """Where each piece of a resumable upload begins, and the piece."""
        offset = 0
        with self._open() as file:
            while piece := file.read(LARGE_PIECE):
                yield offset, piece
                offset += len(piece)

    def tell(self, sent: int) -> None:
        if self._progress is not None:
            self._progress(sent, self.size)

    def _pieces(self) -> Iterator[bytes]:
        """`progress` is told of a piece once the one after it is asked for, which is when the system has taken it."""
        sent = 0
        with self._open() as file:
            while piece := file.read(PIECE):
                yield piece
                sent += len(piece)
                self.tell(sent)


def condition_query(condition: str | Condition) -> dict[str, str | float]:
    """`condition` and what stands beside it in the query, from the compact form or from the document."""
    if isinstance(condition, str):
        return {"condition": condition}
    members: dict[str, Any] = {**condition}
    return {"condition": members.pop("kind"), **members}


def tag_query(labels: Mapping[str, str] | None, session: str | None, recorded_at: str | None) -> dict[str, str | None]:
    """What a recording is called, as the query has it."""
    words = ",".join(f"{name}={value}" for name, value in (labels or {}).items())
    return {"labels": words or None, "session": session, "recorded_at": recorded_at}


def columns_text(columns: Columns | None) -> str | None:
    """NAME=QUANTITY:AXIS:UNIT,... from that form or from the document of columns."""
    if columns is None or isinstance(columns, str):
        return columns
    pieces = []
    for name, column in columns.items():
        if {"=", ","} & set(name):
            raise ValueError(f"The column name {name!r} holds '=' or ','; give the column by its number instead, from \"0\".")
        pieces.append(f"{name}={column['quantity']}:{column.get('axis', '')}:{column.get('unit', '')}".rstrip(":"))
    return ",".join(pieces)
