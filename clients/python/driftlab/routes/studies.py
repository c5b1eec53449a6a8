"""Studies, drives, simulation models and calibrations."""
from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import cast

from ..contract import Calibration, CalibrationSensors, Drive, GetModelImpliedCurvesAnswer, Model
from ..contract import ModelRequest, StoredDrive, StoredStudy, StudyBaseline, StudyRequestRecording
from .base import PAGE, Routes, SortByName, given, operation


class StudyRoutes(Routes):
    @operation("listStudies")
    def studies(self, *, device: str | None = None, page_size: int = PAGE) -> Iterator[StoredStudy]:
        """Studies, oldest first."""
        return self._list("listStudies", {"device": device}, page_size)

    @operation("createStudy")
    def create_study(self, device: str, recordings: Sequence[str | StudyRequestRecording], *, labels: Mapping[str, str] | None = None,
                     baseline: StudyBaseline | None = None, idempotency_key: str | None = None) -> StoredStudy:
        """Names recordings of one device as one study. A recording is its id, or a document that says more of it."""
        members = [{"recording": each} if isinstance(each, str) else each for each in recordings]
        body = given(device={"id": device}, recordings=members, labels=labels, baseline=baseline)
        return cast(StoredStudy, self._post("createStudy", body, idempotency_key))

    @operation("getStudy")
    def study(self, id: str) -> StoredStudy:
        """One study."""
        return cast(StoredStudy, self._get("getStudy", {"id": id}))

    @operation("deleteStudy")
    def delete_study(self, id: str, *, if_match: str | None = None) -> None:
        """Deletes a study; Conflict names the investigations of it."""
        self._transport.call("deleteStudy", {"id": id}, if_match=if_match)

    @operation("listDrives")
    def drives(self, *, device: str | None = None, page_size: int = PAGE) -> Iterator[StoredDrive]:
        """Recorded drives, oldest first."""
        return self._list("listDrives", {"device": device}, page_size)

    @operation("createDrive")
    def create_drive(self, document: Drive, *, idempotency_key: str | None = None) -> StoredDrive:
        """Stores a drive document over uploaded recordings, which is checked; the same document again gives the drive that exists."""
        return cast(StoredDrive, self._post("createDrive", document, idempotency_key))

    @operation("getDrive")
    def drive(self, id: str) -> StoredDrive:
        """One drive."""
        return cast(StoredDrive, self._get("getDrive", {"id": id}))

    @operation("deleteDrive")
    def delete_drive(self, id: str, *, if_match: str | None = None) -> None:
        """Deletes a drive; its evaluations and its recordings stay."""
        self._transport.call("deleteDrive", {"id": id}, if_match=if_match)

    @operation("listModels")
    def models(self, *, device: str | None = None, parent: str | None = None, sort: SortByName | None = None,
               page_size: int = PAGE) -> Iterator[Model]:
        """Simulation models; with `parent` the revisions of that one."""
        return self._list("listModels", {"device": device, "parent": parent, "sort": sort}, page_size)

    @operation("createModel")
    def create_model(self, request: ModelRequest, *, idempotency_key: str | None = None) -> Model:
        """Stores a simulation model; the same document again gives the model that exists."""
        return cast(Model, self._post("createModel", request, idempotency_key))

    @operation("getModel")
    def model(self, id: str) -> Model:
        """One model."""
        return cast(Model, self._get("getModel", {"id": id}))

    @operation("getModelImpliedCurves")
    def model_implied(self, id: str, recording: str, channel: str) -> GetModelImpliedCurvesAnswer:
        """What a simulation model implies at the averaging times of a characterised channel, and what was measured over it."""
        answer = self._get("getModelImpliedCurves", {"id": id}, {"recording": recording, "channel": channel})
        return cast(GetModelImpliedCurvesAnswer, answer)

    @operation("deleteModel")
    def delete_model(self, id: str, *, if_match: str | None = None) -> None:
        """Deletes a model; Conflict names its revisions and the investigations that began or ended with it."""
        self._transport.call("deleteModel", {"id": id}, if_match=if_match)

    @operation("listCalibrations")
    def calibrations(self, *, device: str | None = None, page_size: int = PAGE) -> Iterator[Calibration]:
        """Stored calibrations."""
        return self._list("listCalibrations", {"device": device}, page_size)

    @operation("createCalibration")
    def create_calibration(self, device: str, *, recordings: Sequence[str] | None = None, calibration: CalibrationSensors | None = None,
                           gravity_m_s2: float | None = None, misalignment: bool | None = None,
                           idempotency_key: str | None = None) -> Calibration:
        """Calibrates from uploaded recordings, or keeps a calibration made elsewhere."""
        body = given(device={"id": device}, recordings=None if recordings is None else list(recordings), calibration=calibration,
                     gravity_m_s2=gravity_m_s2, misalignment=misalignment)
        return cast(Calibration, self._post("createCalibration", body, idempotency_key))

    @operation("getCalibration")
    def calibration(self, id: str) -> Calibration:
        """One stored calibration."""
        return cast(Calibration, self._get("getCalibration", {"id": id}))

    @operation("deleteCalibration")
    def delete_calibration(self, id: str, *, if_match: str | None = None) -> None:
        """Deletes a calibration; Conflict names the recordings and studies that use it."""
        self._transport.call("deleteCalibration", {"id": id}, if_match=if_match)
