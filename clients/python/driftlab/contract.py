"""The wire contract as Python types. Made by generate_contract.py from schema/; not edited by hand."""
from __future__ import annotations

from typing import Any, Literal, NamedTuple, NotRequired, TypeAlias, TypedDict


class Operation(NamedTuple):
    """One row of the contract: how a request is put together. Parameters that every request may have are not listed."""

    method: str
    path: str
    query: tuple[str, ...]
    headers: tuple[str, ...]
    media: tuple[str, ...]


DriveTimeOdd = TypedDict("DriveTimeOdd", {"is": NotRequired[Literal['validity', 'arrival']]})
RecordingPreviewColumnOdd = TypedDict("RecordingPreviewColumnOdd", {"from": Literal['header', 'number', 'stated']})
RecordingPreviewRateHzOdd = TypedDict("RecordingPreviewRateHzOdd", {"from": Literal['time_column', 'stated']})


class Attention(TypedDict):
    """Result that must be read. A result whose verdict is not fine."""

    id: str
    # look: usable, with something that a reader must know first; wrong: not to be used as it is.
    level: Literal['look', 'wrong']
    # One sentence that a person could act on.
    verdict: str
    # Of the job; population: a device that its newest characterisation shows not to be of the line of its model.
    kind: str
    # Where the result is read.
    href: str
    job: str
    # null for a result of no device, or of several.
    device: str | None
    device_name: str | None
    # null for a result that is not of one recording.
    recording: str | None
    # The channel of the recording whose verdict this is: the gravest.
    channel: str | None
    created_at: str


class AuditRow(TypedDict):
    sequence: int
    at: str
    # The same in microseconds since 1970, of which the digest is made.
    at_us: int
    # Public id of the token; `local` without authentication, `operator` for the command line, `daemon`.
    actor: str
    action: str
    # The id of what was changed.
    object: str
    request_id: str
    address: str
    detail: str
    # The digest of the row before; 64 zeros for the first.
    previous: str
    # SHA-256 over the other members, see /docs/security.
    digest: str


class Backup(TypedDict):
    # The folder in the directory of backups.
    name: str
    # Complete: all of it was read back. Damaged: complete, of a store in which something is damaged. Failed: there is
    # none.
    state: Literal['running', 'complete', 'damaged', 'failed']
    begun_at: str
    # Null while it is made, and of one that an earlier process made.
    finished_at: str | None
    # Different files of recordings; null while it is made.
    recordings: int | None
    # Of recordings and their columns.
    bytes: int | None
    # Sentences: what is damaged, or why there is none.
    faults: list[str]


class Calibration(TypedDict):
    """Calibration. Bias, scale factor and misalignment of a device's sensors, what they were made from, and what
    corrects readings."""

    id: str
    device: str
    # What it was made from; empty where it was made elsewhere.
    recordings: list[CalibrationRecording]
    gravity_m_s2: NotRequired[float]
    misalignment: NotRequired[bool]
    calibration: CalibrationSensors
    created_at: str


class CalibrationRecording(TypedDict):
    id: str
    revision: int


class CalibrationRequest(TypedDict):
    """Calibration request. Recordings to calibrate from, or a calibration made elsewhere."""

    device: CalibrationRequestDevice
    recordings: NotRequired[list[str]]
    calibration: NotRequired[CalibrationSensors]
    gravity_m_s2: NotRequired[float]
    # Of known positions: estimate how the axes lie to each other too.
    misalignment: NotRequired[bool]


class CalibrationRequestDevice(TypedDict):
    # Name or id of the device.
    id: str


class CalibrationSensor(TypedDict):
    # x = correction (y - bias): y the readings in reading_unit, x the true values in SI.
    apply: CalibrationSensorApply
    # By axis.
    bias: NotRequired[CalibrationEstimates]
    # By axis.
    scale_factor: NotRequired[CalibrationEstimates]
    # By pair of axes: what the first reads of the second. A pair that is not here was not estimated, or is 0 by the
    # choice of the frame.
    misalignment: NotRequired[CalibrationEstimates]
    # Of positions in any attitude: by pair of axes, upper triangle.
    correction: NotRequired[CalibrationEstimates]
    # Readings per true value, by axis.
    matrix: NotRequired[list[list[float]]]
    readings: NotRequired[int]
    positions: NotRequired[int]
    chi_square_per_dof: NotRequired[float | None]
    converged: NotRequired[bool]
    condition_number: NotRequired[float | None]
    warnings: NotRequired[list[str]]
    residual_rms: NotRequired[CalibrationSensorResidualRms]


class CalibrationSensorApply(TypedDict):
    """x = correction (y - bias): y the readings in reading_unit, x the true values in SI."""

    reading_unit: str
    bias: list[float]
    correction: list[list[float]]


class CalibrationSensorResidualRms(TypedDict):
    before: float | None
    after: float | None
    unit: str


class CalibrationSensors(TypedDict):
    """As `driftlab calibrate --json` prints it."""

    accelerometer: NotRequired[CalibrationSensor]
    gyroscope: NotRequired[CalibrationSensor]
    notes: NotRequired[list[str]]


class CampaignPlan(TypedDict):
    """Plan of a measurement campaign. What an investigation left open, and the recordings that would decide most of
    it."""

    study: NotRequired[str]
    open: list[CampaignPlanOpenItem]
    # Those that decide something, most first.
    proposals: list[CampaignPlanProposal]
    # Places in `open` of what no proposal decides.
    undecided: list[int]


class CampaignPlanOpenItem(TypedDict):
    cause: str
    # The column.
    channel: str
    kind: Literal['ambiguous', 'not_examined']
    rivals: list[str]
    needs: str


class CampaignPlanProposal(TypedDict):
    title: str
    channel: str
    # One recording for each.
    conditions: list[Condition]
    # Of each recording.
    duration_s: float | None
    rate_hz: float | None
    # What the recordings must hold.
    columns: list[str]
    # Questions that it is expected to decide.
    expected: float | None
    decides: list[CampaignPlanProposalDecide]


class CampaignPlanProposalDecide(TypedDict):
    # Place in `open`.
    question: int
    cause: str
    rivals: list[str]
    # At which the cause was simulated.
    sizes: dict[str, ModelNumber]
    decided: int
    runs: int
    probability: Quantity


class Characterisation(TypedDict):
    """Characterisation. Variances with intervals, Allan parameters and ranked models of every channel of some
    recordings: the result of a characterise job and of `driftlab characterise --json`."""

    # The study that was characterised; null for single recordings.
    study: Any
    recordings: list[CharacterisationRecording]
    # Of each sensor axis with two recordings or more, by both methods.
    trends: NotRequired[list[Trends]]
    # Each sensor axis with two recordings or more: its recordings put together.
    replicates: NotRequired[list[PooledSensor]]


class CharacterisationChannel(TypedDict):
    # The file's column name.
    channel: str
    quantity: str
    axis: str | None
    # The channel's own unit; `mean`, `allan` and `haar` are in it.
    unit: str
    samples: int
    # Samples absent between the analysed ones; nothing is interpolated.
    missing: NotRequired[int]
    dt_s: float
    mean: float | None
    # Overlapping Allan deviation at octaves.
    allan: CharacterisationChannelAllan
    # Overlapping Allan deviation at the averaging times asked for (`taus`), evenly spaced in the logarithm.
    allan_fine: NotRequired[CharacterisationLongTau]
    # Total deviation, corrected for its bias, on request (`also`).
    total: NotRequired[CharacterisationLongTau]
    # Root of Theo1, corrected for its bias to the Allan variance, on request (`also`).
    theo1: NotRequired[CharacterisationLongTau]
    psd: NotRequired[CharacterisationPsd]
    # Haar wavelet variance; the scale is the length of the filter in samples.
    haar: CharacterisationChannelHaar
    # Where a reference column was subtracted: by how much the channel shows it later, and whether it was shifted by
    # that.
    reference: NotRequired[CharacterisationChannelReference]
    # Whether gross errors move the variances.
    contamination: NotRequired[CharacterisationChannelContamination]
    # Angle or velocity random walk N, the root of the density of rate at low frequencies whatever the model, bias
    # instability B, rate random walk K, quantization Q, rate ramp R: those of the composite models that describe the
    # curve (`description`); empty with a reason where these have none or differ about it.
    allan_parameters: CharacterisationChannelAllanParameters
    # The composite model that describes the curve of variances, found by a stepwise search over all processes on four
    # scales to the octave; null where the record is too short or constant.
    description: NotRequired[CharacterisationDescription | None]
    # Best first.
    fits: list[FitModelFit]
    # By how much, relative to its variances, the curve may differ from every candidate; in the weights of all fits. 0:
    # a candidate is accepted.
    discrepancy: NotRequired[float | None]
    # Models were fitted to the scales of tau from here on; absent: to all.
    from_tau_s: NotRequired[float | None]
    # N and K of the best model as other conventions write them (schema/docs/conventions.md); empty where it has
    # neither.
    equivalents: NotRequired[CharacterisationChannelEquivalents]
    # Indexes `fits`.
    best: int | None
    # Where the noise is not the same before and after. Absent: one noise, as far as the test sees.
    stationarity: NotRequired[CharacterisationChannelStationarity]
    # Allan deviation in windows that overlap by half, where it was asked for.
    dynamic_allan: NotRequired[CharacterisationChannelDynamicAllan]
    warnings: list[str]


class CharacterisationChannelAllan(TypedDict):
    """Overlapping Allan deviation at octaves."""

    tau_s: list[float]
    deviation: list[float | None]
    ci95: list[list[float | None]]
    # Equivalent degrees of freedom.
    edf: NotRequired[list[float | None]]


class CharacterisationChannelAllanParameters(TypedDict):
    """Angle or velocity random walk N, the root of the density of rate at low frequencies whatever the model, bias
    instability B, rate random walk K, quantization Q, rate ramp R: those of the composite models that describe the
    curve (`description`); empty with a reason where these have none or differ about it."""

    N: QuantityIdentified
    B: QuantityIdentified
    K: QuantityIdentified
    Q: QuantityIdentified
    R: QuantityIdentified
    reasons: dict[str, str]


class CharacterisationChannelContamination(TypedDict):
    """Whether gross errors move the variances."""

    verdict: Literal['clean', 'contaminated', 'undecided']
    p: float | None
    disjoint_scales: list[int]
    flagged_samples: int
    # Events of gross errors: flagged samples within 1 s of one another are one. Absent where samples were not flagged
    # one by one.
    bursts: NotRequired[int]
    not_gaussian: NotRequired[bool]


class CharacterisationChannelDynamicAllan(TypedDict):
    """Allan deviation in windows that overlap by half, where it was asked for."""

    window_s: float
    start_s: list[float]
    tau_s: list[float]
    # One row a window, one value a tau, in the unit of the channel.
    deviation: list[list[float | None]]


class CharacterisationChannelEquivalents(TypedDict):
    """N and K of the best model as other conventions write them (schema/docs/conventions.md); empty where it has
    neither."""

    N: NotRequired[list[CharacterisationEquivalent]]
    K: NotRequired[list[CharacterisationEquivalent]]


class CharacterisationChannelHaar(TypedDict):
    """Haar wavelet variance; the scale is the length of the filter in samples."""

    scale: list[int]
    variance: list[float | None]
    ci95: list[list[float | None]]
    # What is left of each variance's precision where samples are missing; absent where none is.
    efficiency_by_scale: NotRequired[list[float | None]]
    # Robust estimate: coefficient by coefficient (Tukey biweight; null where its equation has no root) while no sample
    # is flagged, else sample by sample.
    robust: NotRequired[CharacterisationChannelHaarRobust]


class CharacterisationChannelHaarRobust(TypedDict):
    """Robust estimate: coefficient by coefficient (Tukey biweight; null where its equation has no root) while no sample
    is flagged, else sample by sample."""

    method: NotRequired[Literal['coefficient_wise', 'sample_wise']]
    variance: list[float | None]
    ci95: list[list[Any] | None]
    efficiency: float | None
    efficiency_by_scale: NotRequired[list[float | None]]


class CharacterisationChannelReference(TypedDict):
    """Where a reference column was subtracted: by how much the channel shows it later, and whether it was shifted by
    that."""

    column: str
    applied: bool
    delay: QuantityIdentified
    gain: NotRequired[float | None]
    correlation: NotRequired[float | None]
    warnings: NotRequired[list[str]]
    # Why it was not estimated or not shifted.
    reason: NotRequired[str]


class CharacterisationChannelStationarity(TypedDict):
    """Where the noise is not the same before and after. Absent: one noise, as far as the test sees."""

    # By time.
    changes: list[CharacterisationChannelStationarityChange]
    # From and to: the longest part without a change, to be analysed alone.
    segment_s: list[float]


class CharacterisationChannelStationarityChange(TypedDict):
    # A jump of the mean, or a change of the level of the noise.
    kind: Literal['jump', 'level']
    # After the first analysed sample.
    time_s: float
    # Of a jump in `unit`; else standard deviation after over that before.
    size: float | None
    unit: str
    # The averaging time at which it shows most.
    scale_s: float
    # Standard deviations of the levels; or supremum of a Brownian bridge.
    statistic: float | None


class CharacterisationDescription(TypedDict):
    model: str
    # accepted: not rejected at 1 % as it stands; described: within `discrepancy`; not_described: by nothing within 10
    # %.
    verdict: Literal['accepted', 'described', 'not_described']
    # Of the variances, relative.
    discrepancy: float
    # Of the squared distance; with a discrepancy a measure and no test.
    p: float | None
    parameters: int
    scales: int
    processes: list[dict[str, Any]]
    # Models that describe the curve as well.
    alternatives: list[str]
    # Of coefficients without a value: below this with 95 % confidence.
    upper_limits: dict[str, CharacterisationDescriptionUpperLimit]
    # Averaging time at which B takes the largest share of the Allan variance.
    B_tau_s: float | None
    # What of the model none of the nine candidates has, or that nothing describes the curve; empty where there is
    # nothing to say.
    sentence: str


class CharacterisationDescriptionUpperLimit(TypedDict):
    value: float | None
    unit: str


class CharacterisationEquivalent(TypedDict):
    convention: str
    value: float
    unit: str
    ci95: list[float | None]


class CharacterisationLongTau(TypedDict):
    tau_s: list[float]
    deviation: list[float | None]
    ci95: list[list[float | None]]
    # Equivalent degrees of freedom.
    edf: list[float | None]


class CharacterisationPsd(TypedDict):
    """Power spectral density by sine multitapers, one-sided, in unit^2/Hz, on request (`also`)."""

    frequency_hz: list[float]
    density: list[float | None]
    ci95: list[list[float | None]]
    # Equivalent degrees of freedom.
    edf: list[float | None]
    # Frequencies that stand out of the density around them; noise alone shows one in a hundred records.
    lines: list[CharacterisationPsdLine]


class CharacterisationPsdLine(TypedDict):
    frequency_hz: float
    # Of the sinusoid, in the channel's unit.
    amplitude: float | None
    # Its power over that of the noise around it.
    excess: float | None


class CharacterisationRecording(TypedDict):
    id: str
    condition: Condition
    duration_s: float
    rate_hz: float
    quality: StoredRecordingQuality
    # What the readings were corrected by: a file or an id; absent where they were not.
    calibration: NotRequired[str]
    channels: list[CharacterisationChannel]


class ConditionConstantAngularAcceleration(TypedDict):
    """a constant angular acceleration about an axis, from rest at the first sample of the file."""

    kind: Literal['constant_angular_acceleration']
    axis: ConditionAxis
    value: float
    # A unit of angular acceleration.
    unit: str


class ConditionConstantRate(TypedDict):
    """a constant rate about an axis."""

    kind: Literal['constant_rate']
    axis: ConditionAxis
    value: float
    # A unit of angular rate.
    unit: str


class ConditionProfileDrive(TypedDict):
    """a motion with a reference column, or free motion."""

    kind: Literal['profile', 'drive']


class ConditionSixPosition(TypedDict):
    """one of the six static positions."""

    kind: Literal['six_position']
    axis: ConditionAxis
    # Where the axis points.
    direction: Literal['up', 'down']


class ConditionStatic(TypedDict):
    """at rest."""

    kind: Literal['static']
    # Where the sensor points, clockwise from any fixed direction [deg]. Recordings at several headings are replicates
    # of one condition; an investigation looks for a bias that follows the heading.
    heading_deg: NotRequired[float]


class ContractAnswer(TypedDict):
    openapi: str
    info: dict[str, Any]
    tags: NotRequired[list[Any]]
    paths: dict[str, Any]
    components: dict[str, Any]


class CountSince(TypedDict):
    """How many jobs ended so since that time; where `since` is asked for."""

    at: str
    count: int


class DataSheet(TypedDict):
    """What a manufacturer states of a sensor; members that are not stated are absent."""

    name: str
    manufacturer: str
    # Number or title.
    document: str
    revision: NotRequired[str]
    # Other names of the same sensor.
    also: list[str]
    sensors: list[SensorSheet]


class Device(TypedDict):
    """Device."""

    id: str
    # The user's name of the device; unique.
    name: str
    model: str
    imu: str
    serial: str
    labels: dict[str, str]
    revision: int
    created_at: str
    updated_at: str
    # In lists with `include=summary`.
    summary: NotRequired[DeviceSummary | None]


class DeviceChange(TypedDict):
    model: NotRequired[str]
    imu: NotRequired[str]
    serial: NotRequired[str]
    labels: NotRequired[dict[str, str]]


class DeviceSummary(TypedDict):
    """Device at a glance. How many recordings a device has under which conditions, and the density N at low frequencies
    of each of its axes."""

    recordings: int
    conditions: list[DeviceSummaryCondition]
    # Each sensor axis that was characterised, by the best fit of a recording at rest, or else of the first there is.
    channels: list[DeviceSummaryChannel]
    # The newest result that has a verdict; null where there is none.
    latest: DeviceSummaryLatest | None


class DeviceSummaryChannel(TypedDict):
    quantity: str
    axis: str | None
    recording: str
    condition: Condition | None
    model: str
    N: QuantityIdentified
    # The J test does not reject the model at 1 %; null where it has too few scales.
    fits: bool | None
    level: Literal['fine', 'look']
    # Why it wants a look.
    reason: str | None


class DeviceSummaryCondition(TypedDict):
    condition: Condition | None
    recordings: int


class DeviceSummaryLatest(TypedDict):
    """The newest result that has a verdict; null where there is none."""

    # Of the job; population: the device is not of the line of its model, as its newest characterisation shows.
    kind: Literal['characterise', 'investigate', 'outage_evaluation', 'regress', 'drive_evaluation', 'population']
    # Of what the result is of: the recording, the investigation, the evaluation or the regression; of a population the
    # model.
    id: str
    # Where the result is read.
    href: str
    job: str
    # null: the result speaks of the device, not of one recording.
    recording: str | None
    at: str
    level: Literal['fine', 'look', 'wrong', None]
    # One sentence. null: of a characterisation that was made before verdicts were kept.
    verdict: str | None


class Drive(TypedDict):
    """A recorded drive. One recording of an inertial unit with GNSS fixes and a reference: which files, what their
    columns mean, what the filter believes, which outages are wanted. Lengths in m; body axes forward, right, down.
    Members that are not named here are refused."""

    id: str
    # Decides which constraints may be used.
    vehicle: Literal['road', 'rail', 'rover', 'air', 'foot', 'boat']
    imu: DriveImu
    gnss: DriveGnss
    reference: NotRequired[Literal['withheld_fixes', 'smoothed_fixes'] | DriveReference2]
    odometer: NotRequired[DriveOdometer]
    # What the filter believes, as the sensors of an outage scenario; on a server a sensor or axis may be a stored fit,
    # simulation model or parameter table.
    model: DriveModel
    start: NotRequired[DriveStart]
    outages: NotRequired[DriveOutages]


class DriveColumn(TypedDict):
    quantity: Literal['ignored', 'angular_rate', 'specific_force', 'gnss_position', 'gnss_velocity', 'gnss_speed',
                      'gnss_course', 'gnss_accuracy', 'fix_type', 'satellites', 'reference_position',
                      'reference_velocity', 'odometer_speed', 'odometer_ticks']
    # `-x`: the unit's axis points back; of angular_rate and specific_force.
    axis: NotRequired[Literal['x', 'y', 'z', '-x', '-y', '-z', 'lat', 'lon', 'height', 'north', 'east', 'down', 'up',
                              'horizontal', 'vertical', 'speed']]
    unit: NotRequired[str]


class DriveEvaluationComparedFilter(TypedDict):
    name: str
    about: str
    # What the model's white noise was scaled by.
    noise_factor: DriveEvaluationComparedFilterNoiseFactor
    durations: list[DriveEvaluationDuration]


class DriveEvaluationComparedFilterNoiseFactor(TypedDict):
    """What the model's white noise was scaled by."""

    gyroscope: float
    accelerometer: float


class DriveEvaluationComparison(TypedDict):
    """Several error models as filters through the same outages."""

    # Of the document.
    id: str
    vehicle: str
    # The verdicts.
    summary: str
    algorithm_version: int
    facts: DriveEvaluationFacts
    options: DriveEvaluationComparisonOptions
    # A sentence for each duration: what is shown against the first filter, and how large a difference can be that is
    # not.
    verdicts: list[str]
    filters: list[DriveEvaluationComparedFilter]
    differences: list[DriveEvaluationFilterDifference]
    notes: list[str]
    # What stored simulation models say that a filter is not told.
    left_out: NotRequired[list[DriveEvaluationComparisonLeftOutItem]]


class DriveEvaluationComparisonLeftOutItem(TypedDict):
    where: str
    simulation_model: str
    what: list[str]


class DriveEvaluationComparisonOptions(TypedDict):
    velocity_constraint: bool
    zero_velocity: bool
    odometer: bool
    fit_noise: bool


class DriveEvaluationDuration(TypedDict):
    """Outages of one duration, over all phases."""

    duration_s: float
    period_s: float
    n: int
    rms_m: DriveEvaluationEstimate
    median_m: DriveEvaluationEstimate
    mean_m: float
    p95_m: float
    worst_m: float
    along_rms_m: float
    across_rms_m: float
    nees: DriveEvaluationEstimate
    coverage50: DriveEvaluationEstimate
    coverage95: DriveEvaluationEstimate
    start_error_rms_m: float
    straight_line_rms_m: float
    # By the filter's own covariance.
    promised_rms_m: float
    by_motion: list[DriveEvaluationDurationByMotionItem]
    growth: NotRequired[DriveEvaluationGrowth]
    outages: list[DriveEvaluationOutage]


class DriveEvaluationDurationByMotionItem(TypedDict):
    motion: DriveEvaluationMotion
    n: int
    rms_m: float
    nees: float | None


class DriveEvaluationEstimate(TypedDict):
    """With the interval of a bootstrap over blocks of one period."""

    value: float | None
    ci95: list[float | None]


class DriveEvaluationExplanation(TypedDict):
    """Why a simulation of the drive is too optimistic, and what the mended model gains."""

    # Of the document.
    id: str
    vehicle: str
    # One sentence.
    summary: str
    algorithm_version: int
    facts: DriveEvaluationFacts
    path: NotRequired[DriveEvaluationPath]
    findings: list[DriveEvaluationFinding]
    rungs: list[DriveEvaluationRung]
    white_noise_factors: DriveEvaluationExplanationWhiteNoiseFactors
    before: DriveEvaluationSide
    after: DriveEvaluationSide
    notes: list[str]
    # What stored simulation models say that a filter is not told.
    left_out: NotRequired[list[DriveEvaluationExplanationLeftOutItem]]


class DriveEvaluationExplanationLeftOutItem(TypedDict):
    where: str
    simulation_model: str
    what: list[str]


class DriveEvaluationExplanationWhiteNoiseFactors(TypedDict):
    gyroscope: float
    accelerometer: float


class DriveEvaluationFacts(TypedDict):
    """What is true of the files, before any filter."""

    duration_s: float
    length_m: float
    highest_speed_m_s: float
    # Parts between gaps of the unit.
    runs: int
    imu: DriveEvaluationFactsImu
    gnss: DriveEvaluationFactsGnss
    reference: Literal['withheld_fixes', 'smoothed_fixes', 'own']
    notes: list[str]


class DriveEvaluationFactsGnss(TypedDict):
    fixes: int
    rate_hz: float
    held: int
    other_types: int
    incomplete: int
    far_away: int
    accuracy_constant: bool
    speed_accuracy_constant: bool


class DriveEvaluationFactsImu(TypedDict):
    rows: int
    incomplete_rows: int
    repeated_rows: int
    stuck_rows: int
    polled_faster_than_sampled: bool
    stamped_rate_hz: float
    sensor_rate_hz: float
    jitter_s: float
    gaps_bridged: int
    samples_bridged: int
    gaps_splitting: int
    longest_gap_s: float


class DriveEvaluationFilterDifference(TypedDict):
    """Filter minus the other over the same outages, with the interval of a bootstrap over blocks of one period."""

    duration_s: float
    n: int
    filter: str
    against: str
    difference_m: DriveEvaluationEstimate
    relative: DriveEvaluationEstimate
    # The interval of the relative difference excludes 0.
    shown: bool


class DriveEvaluationFinding(TypedDict):
    """A parameter that the drive shows."""

    cause: str
    # The cause as people call it; absent from evaluations that were made before they had it.
    words: NotRequired[str]
    parameter: str
    title: str
    value: float | None
    se: float | None
    unit: str
    score: float | None
    evidence: str
    told_apart: str
    # The value lies where the search ends, beyond what the cause can be: something else looks like it. Absent from
    # evaluations that were made before it was said.
    at_bound: NotRequired[bool]
    # In the mended model.
    kept: bool
    # Mean log score gained on outages that were not used to find it.
    held_out_gain: float | None
    # A cause whose score was within 2 of this one's when it was named.
    pair: NotRequired[str]
    # That cause as people call it.
    pair_words: NotRequired[str]


class DriveEvaluationGrowth(TypedDict):
    """Horizontal errors against the time in an outage, over the outages; null where no outage has a reference. Absent
    from evaluations that were made before they had it."""

    # After the outage's start; the last is its end.
    time_s: list[float]
    # Outages whose reference says where the vehicle was.
    n: list[int]
    rms_m: list[float | None]
    # The middle 90 % of the outages lie between this and p95_m.
    p05_m: list[float | None]
    median_m: list[float | None]
    p95_m: list[float | None]


class DriveEvaluationInnovation(TypedDict):
    kind: Literal['position', 'velocity', 'constraint', 'zero_velocity', 'odometer', 'zero_turn']
    n: int
    rms: float
    stated_rms: float
    normalised_square: float | None
    correlation_next: float | None
    correlation_1s: float | None
    correlation_4s: float | None


class DriveEvaluationMeasured(TypedDict):
    """Measured outages."""

    # Of the document.
    id: str
    vehicle: str
    # One sentence.
    summary: str
    algorithm_version: int
    facts: DriveEvaluationFacts
    options: DriveEvaluationMeasuredOptions
    path: NotRequired[DriveEvaluationPath]
    starts: list[DriveEvaluationStart]
    durations: list[DriveEvaluationDuration]
    innovations: list[DriveEvaluationInnovation]
    # Gaps of the receiver itself, not scored.
    natural_outages: list[DriveEvaluationMeasuredNaturalOutage]
    rejected_fixes: int
    notes: list[str]
    heading_known_s: float | None
    # What stored simulation models say that a filter is not told.
    left_out: NotRequired[list[DriveEvaluationMeasuredLeftOutItem]]


class DriveEvaluationMeasuredLeftOutItem(TypedDict):
    where: str
    simulation_model: str
    what: list[str]


class DriveEvaluationMeasuredNaturalOutage(TypedDict):
    start_s: float
    duration_s: float


class DriveEvaluationMeasuredOptions(TypedDict):
    velocity_constraint: bool
    zero_velocity: bool
    odometer: bool


class DriveEvaluationOutage(TypedDict):
    """One measured outage: estimate minus reference at its end."""

    start_s: float
    phase: int
    motion: DriveEvaluationMotion
    north_m: float
    east_m: float
    along_m: float
    across_m: float
    # North, north-east, east, of the filter's estimate and the reference.
    covariance_m2: list[float]
    nees: float | None
    start_error_m: float
    straight_line_error_m: float
    # North and east of the first reference point.
    map_m: list[float]


class DriveEvaluationPath(TypedDict):
    """The reference of the drive for a map, some 500 points of it at most: metres north and east of its first."""

    north_m: list[float]
    east_m: list[float]


class DriveEvaluationResource(TypedDict):
    """Drive evaluation with its result."""

    id: str
    job: DriveEvaluationResourceJob
    drive: str
    # The document's own id.
    name: str
    question: Literal['run', 'simulate', 'explain', 'compare']
    seed: int
    state: JobState
    stage: str | None
    progress: float
    created_at: str
    finished_at: str | None
    problem: ProblemStored | None
    evaluation: DriveEvaluation | None


class DriveEvaluationResourceJob(TypedDict):
    href: str


class DriveEvaluationRung(TypedDict):
    """One step of the repair: everything before, and this; errors on outages that found its values and on those that
    did not."""

    name: str
    kept: bool
    durations: list[DriveEvaluationRungDuration]


class DriveEvaluationRungDuration(TypedDict):
    duration_s: float
    found: DriveEvaluationRungDurationFound
    held_out: DriveEvaluationRungDurationHeldOut


class DriveEvaluationRungDurationFound(TypedDict):
    n: int
    rms_m: float
    nees: float | None


class DriveEvaluationRungDurationHeldOut(TypedDict):
    n: int
    rms_m: float
    median_m: float
    nees: float | None
    coverage50: float
    coverage95: float
    coverage95_ci95: NotRequired[list[float | None]]
    log_score: float | None


class DriveEvaluationSide(TypedDict):
    durations: list[DriveEvaluationDuration]
    simulated: list[DriveEvaluationSimulated]


class DriveEvaluationSimulated(TypedDict):
    """The same outages simulated along the same trajectory with the same model."""

    duration_s: float
    n: int
    rms_m: float
    mean_m: float
    median_m: float
    nees: float | None
    coverage50: float
    coverage95: float
    # Of a bootstrap over blocks of one period of one simulated drive, as the two that follow.
    nees_ci95: NotRequired[list[float | None]]
    coverage50_ci95: NotRequired[list[float | None]]
    coverage95_ci95: NotRequired[list[float | None]]
    # The interval holds the scatter of both.
    measured_over_simulated: DriveEvaluationEstimate
    growth: NotRequired[DriveEvaluationGrowth]


class DriveEvaluationSimulation(TypedDict):
    """Measured outages, and the same simulated."""

    # Of the document.
    id: str
    vehicle: str
    # One sentence.
    summary: str
    algorithm_version: int
    facts: DriveEvaluationFacts
    options: DriveEvaluationSimulationOptions
    path: NotRequired[DriveEvaluationPath]
    starts: list[DriveEvaluationStart]
    durations: list[DriveEvaluationDuration]
    innovations: list[DriveEvaluationInnovation]
    # Gaps of the receiver itself, not scored.
    natural_outages: list[DriveEvaluationSimulationNaturalOutage]
    rejected_fixes: int
    notes: list[str]
    heading_known_s: float | None
    simulated: list[DriveEvaluationSimulated]
    # What stored simulation models say that a filter is not told.
    left_out: NotRequired[list[DriveEvaluationSimulationLeftOutItem]]


class DriveEvaluationSimulationLeftOutItem(TypedDict):
    where: str
    simulation_model: str
    what: list[str]


class DriveEvaluationSimulationNaturalOutage(TypedDict):
    start_s: float
    duration_s: float


class DriveEvaluationSimulationOptions(TypedDict):
    velocity_constraint: bool
    zero_velocity: bool
    odometer: bool


class DriveEvaluationStart(TypedDict):
    time_s: float
    roll_deg: float
    pitch_deg: float
    heading_deg: float
    tilt_from: Literal['stated', 'rest', 'motion']
    heading_from: Literal['stated', 'course']


class DriveEvaluationSummary(TypedDict):
    """Drive evaluation without its result."""

    id: str
    job: DriveEvaluationSummaryJob
    drive: str
    # The document's own id.
    name: str
    question: Literal['run', 'simulate', 'explain', 'compare']
    seed: int
    state: JobState
    stage: str | None
    progress: float
    created_at: str
    finished_at: str | None
    problem: ProblemStored | None


class DriveEvaluationSummaryJob(TypedDict):
    href: str


class DriveGnss(TypedDict):
    file: NotRequired[str]
    recording: NotRequired[str]
    columns: DriveColumns
    time: DriveTime
    # Those to be used; left out: all.
    fix_types: NotRequired[list[int]]
    # From the unit to the antenna.
    lever_arm_m: NotRequired[list[float]]
    lever_arm_sd_m: NotRequired[float]
    # By how much a stamp is later than the moment described.
    latency_s: NotRequired[DriveGnssLatencyS]
    # The file repeats a fix until the next one.
    hold: NotRequired[bool]
    height_above: NotRequired[Literal['ellipsoid', 'geoid']]
    # North, east, down, for fixes that state none worth believing.
    position_sd_m: NotRequired[list[float]]
    velocity_sd_m_s: NotRequired[list[float]]


class DriveGnssLatencyS(TypedDict):
    """By how much a stamp is later than the moment described."""

    position: NotRequired[float]
    velocity: NotRequired[float]


class DriveImu(TypedDict):
    file: NotRequired[str]
    recording: NotRequired[str]
    columns: DriveColumns
    time: DriveTime
    # Where the specific force has a file of its own.
    accelerometer: NotRequired[DriveSource]
    # Roll, pitch, yaw: body = C sensor. "unknown": from gravity and from force against change of speed.
    mounting_deg: NotRequired[list[float] | Literal['unknown']]
    mounting_sd_deg: NotRequired[float]
    # Who stamps the rows: the sensor, a computer that asks, a computer that receives.
    clock: NotRequired[Literal['sensor', 'host', 'arrival']]


class DriveModel(TypedDict):
    """What the filter believes, as the sensors of an outage scenario; on a server a sensor or axis may be a stored fit,
    simulation model or parameter table."""

    gyroscope: dict[str, Any]
    accelerometer: dict[str, Any]


class DriveOdometer(TypedDict):
    file: NotRequired[str]
    recording: NotRequired[str]
    columns: DriveColumns
    time: DriveTime
    metres_per_tick: NotRequired[float]
    # From the unit to the wheel.
    lever_arm_m: NotRequired[list[float]]
    sd_m_s: NotRequired[float]


class DriveOutages(TypedDict):
    duration_s: NotRequired[list[float]]
    # The period of each duration; at least 20 s of fixes remain.
    every_s: NotRequired[list[float]]
    phases: NotRequired[int]
    settle_s: NotRequired[float]
    # Starts [s after the first reading] in place of phases.
    at: NotRequired[list[float]]


class DriveReference2(TypedDict):
    file: NotRequired[str]
    recording: NotRequired[str]
    columns: DriveColumns
    time: DriveTime
    lever_arm_m: NotRequired[list[float]]
    sd_m: NotRequired[float]


class DriveSource(TypedDict):
    file: NotRequired[str]
    recording: NotRequired[str]
    columns: DriveColumns
    time: DriveTime


class DriveStart(TypedDict):
    position: NotRequired[DriveStartPosition]
    velocity_ned_m_s: NotRequired[list[float]]
    heading_deg: NotRequired[float]
    roll_deg: NotRequired[float]
    pitch_deg: NotRequired[float]


class DriveStartPosition(TypedDict):
    latitude_deg: NotRequired[float]
    longitude_deg: NotRequired[float]
    height_m: NotRequired[float]


class DriveTime(DriveTimeOdd):
    column: NotRequired[str]
    unit: NotRequired[Literal['s', 'ms', 'us', 'ns']]
    scale: Literal['gps', 'utc', 'unix', 'boot', 'row']
    offset_s: NotRequired[float]
    # Where the scale is `row`.
    rate_hz: NotRequired[float]
    # An RTKLIB time tag that dates the file; not on a server.
    tag: NotRequired[str]
    # What such a tag says: GPS time of the first and of the last row [s since 1970].
    dates: NotRequired[DriveTimeDates]


class DriveTimeDates(TypedDict):
    """What such a tag says: GPS time of the first and of the last row [s since 1970]."""

    first_s: float
    last_s: float


class Export(TypedDict):
    """The file of a target for a device."""

    target: str
    title: str
    file: str
    convention: str
    source: str
    device: str
    recordings: list[str]
    # A sentence for each name without a value or with an upper limit.
    gaps: list[str]
    text: str


class ExportTarget(TypedDict):
    """A program whose file can be written, and what its numbers mean."""

    target: str
    title: str
    # Name of the file by custom.
    file: str
    convention: str
    # Where the convention is stated.
    source: str


class FinishLiveRecordingAnswer(TypedDict):
    recording: StoredRecording
    job: Job | None


class Fit(TypedDict):
    """Stored fit. One model fitted to one channel, with where it comes from."""

    id: str
    device: str
    recording: str
    recording_revision: int
    job: str
    # The file's column name.
    channel: str
    quantity: str
    axis: str | None
    condition: Condition
    # 0 is the best by the criterion.
    rank: int
    model: str
    robust: bool
    processes: FitModelFitProcesses
    objective: float | None
    wic: float | None
    equation_8: NotRequired[float | None]
    optimism: NotRequired[float | None]
    condition_number: NotRequired[float | None]
    bounds_active: NotRequired[list[str]]
    intervals: NotRequired[FitModelFitIntervals]
    plausible: NotRequired[bool]
    distance_2p: NotRequired[float]
    closest: NotRequired[bool]
    j_test: FitModelFitJTest | None
    verdict: NotRequired[FitModelFitVerdict]
    described_within: NotRequired[float | None]
    status: str
    warnings: list[str]
    # The density N of the channel at low frequencies, whatever the model; absent from fits that were stored before fits
    # kept it.
    density: NotRequired[QuantityIdentified]
    created_at: str


class FitModelFit(TypedDict):
    model: str
    robust: bool
    processes: list[FitProcess]
    # The least squared distance on the logarithms of the variances, under the covariance and the discrepancy of the
    # curve.
    objective: float | None
    # The criterion that ranks (schema/docs/analysis.md); smaller is better.
    wic: float | None
    # Equation 8 of the seed paper with its optimism, diagonal weights.
    equation_8: NotRequired[float | None]
    # The second term of equation 8: what choosing the parameters on the same data gains.
    optimism: NotRequired[float | None]
    # Ratio of the best to the worst known combination of the logarithms of the parameters; null: one is not known at
    # all.
    condition_number: NotRequired[float | None]
    # Parameters at an end of their range.
    bounds_active: NotRequired[list[str]]
    # How the parameters' intervals were made.
    intervals: NotRequired[Literal['profile', 'sandwich', 'bootstrap']]
    # Twice the number of parameters more than the distance (objective, under the covariance that ranks), above the
    # least of all candidates. A model within 6 is plausible: the order by `wic`, which weighs parameters more, may rank
    # first a model that is not.
    distance_2p: NotRequired[float]
    # The candidate with the least `distance_2p`.
    closest: NotRequired[bool]
    # In the set of models that the data cannot tell apart from the best.
    plausible: NotRequired[bool]
    # The test of over-identifying restrictions; null where the model leaves no degrees of freedom.
    j_test: FitModelFitJTest | None
    # accepted: the J test does not reject at 0.01; described: it does, but the model is within 2 % of the variances;
    # null: of a result made before the verdict was.
    verdict: NotRequired[Literal['accepted', 'described', 'not_described', 'untested', None]]
    # Relative error of the variances that the model leaves beyond their scatter; 0 where it is accepted. The intervals
    # allow for it.
    described_within: NotRequired[float | None]
    status: str
    warnings: list[str]


class FitModelFitJTest(TypedDict):
    """The test of over-identifying restrictions; null where the model leaves no degrees of freedom."""

    statistic: float | None
    dof: float | None
    p: float | None


class FitProcess(TypedDict):
    process: str
    params: dict[str, QuantityIdentified]
    # Why a parameter is null.
    reasons: NotRequired[dict[str, str]]


class GetCountsAnswer(TypedDict):
    devices: int
    recordings: int
    # Only with `include=attention`.
    attention: NotRequired[list[Attention]]
    jobs: GetCountsAnswerJobs


class GetCountsAnswerJobs(TypedDict):
    queued: int
    running: int
    succeeded_since: NotRequired[CountSince]
    failed_since: NotRequired[CountSince]


class GetImpliedCurvesAnswer(TypedDict):
    fit: str
    model: str
    implied: RecordingCharacterisationImplied


class GetModelImpliedCurvesAnswer(TypedDict):
    model: str
    recording: str
    channel: str
    processes: ModelProcesses
    # Causes of effects on the channel that no curve holds; `unnamed`: profiles of what has no name.
    left_out: list[str]
    implied: RecordingCharacterisationImplied


class GetSchemaAnswer(TypedDict):
    cases: list[GetSchemaAnswerCase]


class GetSchemaAnswerCase(TypedDict):
    value: float
    ci95: list[float] | None
    text: str


class GetWorkersAnswer(TypedDict):
    # Jobs that run at a time; more wait.
    workers: int


class HealthAnswer(TypedDict):
    status: Literal['alive']
    version: str


class Histogram(TypedDict):
    """Histogram. How the values of a channel's error series are distributed, in robust standard deviations (1.4826
    times the median absolute deviation) from the median."""

    unit: str
    dt_s: float
    samples: int
    first_s: float
    median: float | None
    # Robust standard deviation; null where there is none, with the reason, and without the members below.
    sigma: float | None
    reason: NotRequired[str]
    # Of the bins, in robust standard deviations; one more than counts.
    edges: NotRequired[list[float]]
    counts: NotRequired[list[int]]
    # What Gaussian noise of that width would give.
    gaussian: NotRequired[list[float]]
    # Values under the first edge.
    below: NotRequired[int]
    above: NotRequired[int]
    # Where gross errors are: values more than eight robust standard deviations from the median of their 64 samples and
    # from those of the 64 before and behind. Those within 1 s of one another are one place; of more than 200 those that
    # are farthest out.
    apart: NotRequired[list[HistogramApartItem]]


class HistogramApartItem(TypedDict):
    # Seconds since the first row of the file.
    t0: float
    t1: float
    samples: int
    # Robust standard deviations of the one that is farthest out.
    deviations: float


class Investigation(TypedDict):
    """Investigation. What a simulation gets wrong about the recordings of a study, and why."""

    study: str
    # What it comes to: one sentence, what stands behind it, how much a person should care, and the members that the
    # sentence rests on.
    summary: NotRequired[RecordingCharacterisationSummary]
    # From here on, of stored investigations alone.
    id: NotRequired[str]
    job: NotRequired[str]
    device: NotRequired[str]
    # The model that was criticised.
    baseline_model: NotRequired[str]
    # The extended model as it is stored; the baseline where nothing was found.
    model: NotRequired[str]
    created_at: NotRequired[str]
    baseline: InvestigationModel
    checks: list[InvestigationCheck]
    # In the order in which a laboratory would act on them: by certainty and concern, then the strongest cause first;
    # findings of one cause stand together.
    findings: list[InvestigationFinding]
    # The findings of each cause, in order.
    groups: NotRequired[list[InvestigationGroup]]
    # One for each examined channel.
    figures: NotRequired[list[InvestigationFigures]]
    extended_model: InvestigationModel
    gain: InvestigationGain
    unexplained: list[InvestigationUnexplainedItem]
    # Profiles of what no cause explains, which the extended model holds without a name.
    unnamed: NotRequired[list[InvestigationUnnamedItem]]
    not_examined: NotRequired[list[InvestigationNotExaminedItem]]
    notes: NotRequired[list[str]]
    # Of reports that `driftlab plan` writes: the recordings to make next.
    plan: NotRequired[CampaignPlan]


class InvestigationBand(TypedDict):
    q025: list[float | None]
    median: list[float | None]
    q975: list[float | None]


class InvestigationCheck(TypedDict):
    id: str
    recording: str | None
    channel: str
    observed: float | None
    simulated: InvestigationCheckSimulated
    p: float | None
    p_adjusted: float | None
    failed: bool
    # For people.
    title: NotRequired[str]
    # The same under the extended model.
    observed_after: NotRequired[float | None]
    p_after: NotRequired[float | None]
    p_after_adjusted: NotRequired[float | None]
    failed_after: NotRequired[bool]
    # Where a check that fails comes to rest: a finding rests on it, the extended model mends it though no finding names
    # it, or it stands under `unexplained`.
    end: NotRequired[Literal['finding', 'mended', 'unexplained', None]]


class InvestigationCheckSimulated(TypedDict):
    q025: float | None
    median: float | None
    q975: float | None


class InvestigationFigures(TypedDict):
    """What the figures of a channel need, over all its recordings: measured against simulated by the baseline that
    knows of no effect, and what remains against the extended model."""

    # The column.
    channel: str
    # The recording of the course.
    recording: str
    unit: str
    # Allan deviation [unit]; extended: with the effects that were taken off put back.
    allan: InvestigationFiguresAllan
    # Haar wavelet deviation by scale.
    wavelet: InvestigationFiguresWavelet
    # What the checks judge: wavelet variance of a recording's innovations over that of a right model, and where 95 % of
    # right models lie.
    innovations: list[InvestigationFiguresInnovation]
    # Two-sided density [unit^2/Hz], mean over stretches of equal length of all recordings, in bins of equal width.
    # highest: the largest ordinate of each bin; chance: what the largest of all ordinates exceeds in one spectrum of
    # twenty without a line.
    spectrum: InvestigationFiguresSpectrum
    # Means over stretches of time of one recording; `effect` is what the extended model puts into the mean.
    course: InvestigationFiguresCourse
    # The innovations of the recording whose noise changes most, where noise still changes beside the findings: density
    # over that of white noise, by time and frequency.
    spectrogram: NotRequired[InvestigationFiguresSpectrogram]


class InvestigationFiguresAllan(TypedDict):
    """Allan deviation [unit]; extended: with the effects that were taken off put back."""

    tau_s: NotRequired[list[float | None]]
    measured: NotRequired[list[float | None]]
    baseline: NotRequired[list[float | None]]
    extended: NotRequired[list[float | None]]


class InvestigationFiguresCourse(TypedDict):
    """Means over stretches of time of one recording; `effect` is what the extended model puts into the mean."""

    time_s: NotRequired[list[float | None]]
    error: NotRequired[list[float | None]]
    effect: NotRequired[list[float | None]]


class InvestigationFiguresInnovation(TypedDict):
    recording: str
    scale_s: float | None
    before: float | None
    after: float | None
    q025: float | None
    q975: float | None


class InvestigationFiguresSpectrogram(TypedDict):
    """The innovations of the recording whose noise changes most, where noise still changes beside the findings: density
    over that of white noise, by time and frequency."""

    recording: str
    # Middle of each cell from the first sample of the file.
    time_s: list[float | None]
    # Mean frequency of each band, rising.
    f_hz: list[float | None]
    # One row per time, one number per band: 0 as expected, 1 ten times as much.
    log10_ratio: list[list[float | None]]


class InvestigationFiguresSpectrum(TypedDict):
    """Two-sided density [unit^2/Hz], mean over stretches of equal length of all recordings, in bins of equal width.
    highest: the largest ordinate of each bin; chance: what the largest of all ordinates exceeds in one spectrum of
    twenty without a line."""

    f_hz: NotRequired[list[float | None]]
    measured: NotRequired[list[float | None]]
    highest: NotRequired[list[float | None]]
    baseline: NotRequired[InvestigationBand]
    chance: NotRequired[list[float | None]]
    remaining: NotRequired[list[float | None]]
    highest_remaining: NotRequired[list[float | None]]


class InvestigationFiguresWavelet(TypedDict):
    """Haar wavelet deviation by scale."""

    scale_s: NotRequired[list[float | None]]
    measured: NotRequired[list[float | None]]
    baseline: NotRequired[InvestigationBand]
    remaining: NotRequired[list[float | None]]
    extended: NotRequired[InvestigationBand]


class InvestigationFinding(TypedDict):
    cause: str
    title: NotRequired[str]
    # The equation of the effect as one line of text: y is the channel's error, x what the sensor sees, z what the file
    # says, k the number of a sample.
    equation: NotRequired[str]
    concern: NotRequired[InvestigationConcern]
    status: Literal['identified', 'ambiguous']
    alternatives: list[str]
    # The alternatives with their scores.
    rivals: NotRequired[list[InvestigationFindingRival]]
    channels: list[str]
    because: list[str]
    explanation: str
    parameters: Investigation
    score: NotRequired[float | None]
    gain: InvestigationFindingGain
    next_measurement: str | None


class InvestigationFindingGain(TypedDict):
    log_score_per_sample: float | None
    misfit_before: float | None
    misfit_after: float | None
    heldout: bool
    heldout_share: NotRequired[float | None]
    heldout_samples: NotRequired[float | None]
    # It tells how the file was written; no sum of gains holds it.
    of_the_file: NotRequired[bool]
    # Share of the misfit.
    explained: NotRequired[float | None]


class InvestigationFindingRival(TypedDict):
    cause: str
    title: str
    score: float | None


class InvestigationGain(TypedDict):
    misfit_before: float | None
    misfit_after: float | None
    checks_failed_before: int
    checks_failed_after: int
    # Share of the misfit that the findings explain on samples they were not fitted to; what facts of the file tell is
    # no part of it.
    explained: NotRequired[float | None]
    # Mean horizontal position error [m] at the end of two simulated outages of 10 s. null: no axis of an inertial unit
    # was examined.
    outage_error_m: InvestigationGainOutageErrorM


class InvestigationGainOutageErrorM(TypedDict):
    """Mean horizontal position error [m] at the end of two simulated outages of 10 s. null: no axis of an inertial unit
    was examined."""

    # As the baseline predicts it for a filter that believes it.
    baseline: float | None
    # As the extended model predicts it for the same filter.
    extended: float | None
    # Along a reference trajectory, where the study holds one.
    measured: float | None
    # As the extended model predicts it for a filter that believes the extended model.
    adopted: NotRequired[float | None]
    ci95: NotRequired[InvestigationGainOutageErrorMCi95]
    # Findings that the navigation simulation cannot hold.
    left_out: NotRequired[list[str]]
    # Processes that are in the data and in no filter.
    left_out_of_filters: NotRequired[list[str]]


class InvestigationGainOutageErrorMCi95(TypedDict):
    baseline: NotRequired[list[float | None]]
    extended: NotRequired[list[float | None]]
    adopted: NotRequired[list[float | None]]


class InvestigationGroup(TypedDict):
    cause: str
    title: str
    concern: InvestigationConcern
    # Places in `findings`.
    findings: list[int]
    # Columns.
    channels: list[str]


class InvestigationModel(TypedDict):
    processes: list[dict[str, Any]]
    deterministic: dict[str, Any]
    channels: NotRequired[dict[str, Any]]
    effects: NotRequired[list[InvestigationModelEffect]]
    unnamed: NotRequired[ModelUnnamed]


class InvestigationModelEffect(TypedDict):
    cause: str
    channels: list[str]
    # Where it acts; left out: everywhere.
    recordings: NotRequired[list[str]]
    params: dict[str, ModelNumber]


class InvestigationNotExaminedItem(TypedDict):
    cause: str
    channel: str
    needs: str


class InvestigationSummary(TypedDict):
    """Investigation in a list."""

    id: str
    job: str
    device: str
    study: str
    baseline_model: str
    model: str
    findings: list[InvestigationSummaryFinding]
    created_at: str


class InvestigationSummaryFinding(TypedDict):
    cause: str
    status: Literal['identified', 'ambiguous']
    channels: list[str]
    log_score_per_sample: float | None


class InvestigationUnexplainedItem(TypedDict):
    channel: str
    explanation: str
    checks: list[str]


class InvestigationUnnamedItem(TypedDict):
    kind: Literal['spectrum', 'variance', 'mean']
    against: Literal['frequency', 'time', 'phase', 'rate', 'angular_acceleration', 'temperature', 'warming', 'angle']
    # Of a phase: the time since the start of the recording, modulo this.
    period_s: NotRequired[float]
    # The unit of the edges.
    along: str
    channel: str
    # Where it acts; left out: everywhere.
    recordings: NotRequired[list[str]]
    edges: list[float | None]
    # Drawn towards the model by as much as they are uncertain.
    values: list[float | None]
    # Of the values of a mean.
    unit: NotRequired[str]
    # Of the bins; of frequencies the geometric ones.
    middles: list[float | None]
    # Ends of 95 % intervals, as wide as those of the values before they are drawn.
    q025: list[float | None]
    q975: list[float | None]
    gain: InvestigationUnnamedItemGain
    explanation: str


class InvestigationUnnamedItemGain(TypedDict):
    # Log likelihood gained on data that the profile was not fitted to [nat].
    log_score: float | None
    log_score_per_sample: float | None
    heldout_samples: float | None


class IssuedToken(TypedDict):
    # Public; what logs and the audit log name.
    id: str
    name: str
    scope: Scope
    # null: every device.
    devices: list[str] | None
    created_at: str
    expires_at: str | None
    revoked_at: str | None
    rotated_at: str | None
    # To the minute.
    last_used_at: str | None
    # Shown this once.
    secret: str


class IssuedWebhook(TypedDict):
    id: str
    url: str
    description: str
    events: WebhookEvents
    enabled: bool
    disabled_at: str | None
    # A sentence.
    disabled_why: str | None
    # Deliveries given up since the last that arrived.
    given_up: int
    previous_secret_until: str | None
    revision: int
    created_at: str
    updated_at: str
    # Shown this once.
    secret: str


class Job(TypedDict):
    """Job."""

    id: str
    kind: str
    state: JobState
    # What the worker is doing.
    stage: str | None
    progress: float
    # Grows with every start; 0 before the first.
    attempt: int
    priority: int
    cancel_requested: bool
    created_at: str
    started_at: str | None
    # Set if and only if the state is final.
    finished_at: str | None
    # Of the device that the request is about; null where that is none or several.
    device_name: str | None
    # Of the recording that the request is about; null where that is none, several or one without a name.
    recording_name: str | None
    # What was asked for, complete: equal requests are one job. In lists without inputs and parameters where the row of
    # the job is damaged, as `problem` then says.
    request: JobRequestMember
    # Where the result is, once the job has succeeded.
    result: JobResult | None
    # Why the last attempt failed.
    problem: ProblemStored | None
    # The problem of every failed attempt, oldest first; empty in lists.
    failed_attempts: list[ProblemStored]


class JobEvent(TypedDict):
    """Data of one server-sent event."""

    job: str
    state: JobState
    stage: str | None
    progress: float
    attempt: int
    at: str
    partial: NotRequired[OutageEvaluationPartial]


class JobRequestArm(TypedDict):
    """Recordings, or with labels alone all recordings of the device that have them."""

    labels: NotRequired[dict[str, str]]
    recordings: NotRequired[list[JobRequestArmRecording]]


class JobRequestArmRecording(TypedDict):
    recording: str
    # One power-up of the device.
    session: NotRequired[str]
    recorded_at: NotRequired[str]
    temperature_degc: NotRequired[float]
    # Range of the sensor: gyroscope [deg/s], accelerometer [g]. Arms with different ones are not compared.
    full_scale: NotRequired[JobRequestArmRecordingFullScale]
    # What an investigation identified.
    causes: NotRequired[list[str]]


class JobRequestArmRecordingFullScale(TypedDict):
    """Range of the sensor: gyroscope [deg/s], accelerometer [g]. Arms with different ones are not compared."""

    gyroscope: NotRequired[float]
    accelerometer: NotRequired[float]


class JobRequestCharacterise(TypedDict):
    kind: Literal['characterise']
    # Recordings, or a study that names them.
    inputs: JobRequestCharacteriseInputs
    parameters: NotRequired[JobRequestCharacteriseParameters]
    priority: NotRequired[int]


class JobRequestCharacteriseInputs(TypedDict):
    """Recordings, or a study that names them."""

    study: NotRequired[str]
    recordings: NotRequired[list[str]]


class JobRequestCharacteriseParameters(TypedDict):
    # Candidate models; the default is the nine of the seed paper's Table 3.
    models: NotRequired[list[str]]
    seed: NotRequired[int]
    # stepwise: from the best of `models` on, process by process over all that are known.
    search: NotRequired[Literal['listed', 'stepwise']]
    # Replicates (40 or more) of a parametric bootstrap of the best model's intervals.
    bootstrap: NotRequired[int]
    # Windows (2 or more) of a dynamic Allan deviation; 0: none.
    dynamic: NotRequired[int]
    # Curves beside the Allan and wavelet variances: total deviation and Theo1 for the longest tau, power spectral
    # density with lines.
    also: NotRequired[list[Literal['total', 'theo1', 'psd']]]
    # Averaging times (2 or more) of a finer Allan curve, evenly spaced in the logarithm; 0: none.
    taus: NotRequired[int]
    # Models are fitted to the scales of tau from here on, where a filter of the sensor rules the first ones; 0: all.
    from_tau_s: NotRequired[float]


class JobRequestDriveEvaluation(TypedDict):
    kind: Literal['drive_evaluation']
    inputs: JobRequestDriveEvaluationInputs
    parameters: NotRequired[JobRequestDriveQuestion]
    priority: NotRequired[int]


class JobRequestDriveEvaluationInputs(TypedDict):
    drive: str
    # In place of the document's.
    model: NotRequired[DriveModel]
    # In place of the document's.
    outages: NotRequired[DriveOutages]


class JobRequestDriveQuestion(TypedDict):
    # Measure outages; simulate the same beside them; say why the two differ; compare several models.
    question: NotRequired[Literal['run', 'simulate', 'explain', 'compare']]
    # The vehicle moves along its nose.
    velocity_constraint: NotRequired[bool]
    # Zero velocity and no turn at rest; not of `explain`.
    zero_velocity: NotRequired[bool]
    # Use the odometer; not of `explain`.
    odometer: NotRequired[bool]
    # Of `run` and `compare`: reject fixes with a normalised squared innovation above; 0: none.
    gate: NotRequired[float]
    # Of `run` and `compare`: believe the unit's stamps and keep repeated rows.
    as_stamped: NotRequired[bool]
    seed: NotRequired[int]
    # Simulated drives; of `simulate` and `explain`.
    runs: NotRequired[int]
    # Estimate the lever arm, and with velocity constraints the mounting, by the document's standard deviations; with
    # velocity constraints also where the axle lies, and with an odometer its scale; not of `explain`.
    estimate: NotRequired[bool]
    # Of `compare`: at least two; the first is what the others are compared with.
    models: NotRequired[list[JobRequestDriveQuestionModel]]
    # Of `compare`: scale each model's white noise to the innovations first.
    fit_noise: NotRequired[bool]


class JobRequestDriveQuestionModel(TypedDict):
    # Without `model` one that is known: `document`, `document-white`, a filter of the paper such as `M_dyn(GMWM)`.
    name: str
    model: NotRequired[DriveModel]


class JobRequestInvestigate(TypedDict):
    kind: Literal['investigate']
    inputs: JobRequestInvestigateInputs
    parameters: NotRequired[JobRequestInvestigateParameters]
    priority: NotRequired[int]


class JobRequestInvestigateInputs(TypedDict):
    study: str


class JobRequestInvestigateParameters(TypedDict):
    # In place of the study's own.
    baseline: NotRequired[StudyBaseline]


class JobRequestMember(TypedDict):
    """What was asked for, complete: equal requests are one job. In lists without inputs and parameters where the row of
    the job is damaged, as `problem` then says."""

    kind: str
    inputs: JobRequestMemberInputs
    parameters: JobRequestMemberParameters
    # Of a regression run against the anchor: the settings kept with it.
    kept: NotRequired[dict[str, Any] | None]
    # Of a regression run: the settings that the request named.
    stated: NotRequired[list[str]]
    # Of a regression run: which look at the candidate label it is.
    look: NotRequired[JobRequestMemberLook]
    algorithm_version: int


class JobRequestMemberInputs(TypedDict):
    # The study that named the recordings.
    study: NotRequired[str]
    # Of a pooling: the id of the device.
    device: NotRequired[str]
    # Of a pooling.
    quantity: NotRequired[str]
    # Of a pooling.
    axis: NotRequired[str]
    # Of a pooling: ids of the results that are put together, sorted.
    members: NotRequired[list[str]]
    recordings: NotRequired[list[JobRequestMemberInputsRecording]]
    # Of an outage evaluation: a name, or the document.
    scenario: NotRequired[str | dict[str, Any]]
    # Of a drive evaluation.
    drive: NotRequired[str]
    # Of a drive evaluation: the drive, its model complete.
    document: NotRequired[dict[str, Any]]
    # Of an evaluation: what its stored simulation models say that a scenario or filter does not hold.
    left_out: NotRequired[list[dict[str, Any]]]
    # Of a regression run.
    device_name: NotRequired[str]
    # Of a regression run: label, and recordings with the results they are compared by.
    baseline: NotRequired[dict[str, Any]]
    # Of a regression run, as the baseline.
    candidate: NotRequired[dict[str, Any]]
    # Of a regression run: earlier releases.
    history: NotRequired[list[dict[str, Any]]]
    # Of a regression run: recordings left out, and why.
    excluded: NotRequired[list[dict[str, Any]]]
    # Of a regression run whose history is that of earlier runs: how many of these releases came before the baseline.
    before_baseline: NotRequired[int]
    # Of such a run: place in `history` of the release before the candidate.
    previous: NotRequired[int]


class JobRequestMemberInputsRecording(TypedDict):
    id: str
    revision: int
    # In the study of an investigation.
    name: NotRequired[str]


class JobRequestMemberLook(TypedDict):
    """Of a regression run: which look at the candidate label it is."""

    number: NotRequired[int]
    counted: NotRequired[bool]


class JobRequestMemberParameters(TypedDict):
    models: NotRequired[list[str | dict[str, Any]]]
    seed: NotRequired[int]
    search: NotRequired[Literal['listed', 'stepwise']]
    bootstrap: NotRequired[int]
    dynamic: NotRequired[int]
    also: NotRequired[list[Literal['total', 'theo1', 'psd']]]
    taus: NotRequired[int]
    runs: NotRequired[int]
    # Of a drive evaluation, as the seven that follow.
    question: NotRequired[Literal['run', 'simulate', 'explain', 'compare']]
    velocity_constraint: NotRequired[bool]
    zero_velocity: NotRequired[bool]
    odometer: NotRequired[bool]
    gate: NotRequired[float]
    as_stamped: NotRequired[bool]
    estimate: NotRequired[bool]
    fit_noise: NotRequired[bool]
    relative_precision: NotRequired[float]
    # Of an investigation, complete.
    baseline: NotRequired[dict[str, Any]]
    # Of a regression run, as all that follow.
    alpha: NotRequired[float]
    margin: NotRequired[dict[str, Any]]
    through_s: NotRequired[float]
    min_edf: NotRequired[float]
    design_power: NotRequired[float]
    tau0: NotRequired[dict[str, Any]]
    prior_df: NotRequired[float]
    session_df: NotRequired[int]
    fail_on: NotRequired[str]
    two_sided: NotRequired[bool]
    event_limits: NotRequired[dict[str, Any]]
    looks: NotRequired[int]


class JobRequestOutageEvaluation(TypedDict):
    kind: Literal['outage_evaluation']
    inputs: JobRequestOutageEvaluationInputs
    parameters: NotRequired[JobRequestOutageEvaluationParameters]
    priority: NotRequired[int]


class JobRequestOutageEvaluationInputs(TypedDict):
    scenario: Literal['paper', 'paper-position-only', 'paper-nhc', 'paper-s-curves'] | OutageScenario


class JobRequestOutageEvaluationParameters(TypedDict):
    runs: NotRequired[int]
    seed: NotRequired[int]
    relative_precision: NotRequired[float]


class JobRequestPool(TypedDict):
    """The latest results of one sensor axis, put together. The daemon queues these by itself whenever such results
    change; to ask for one is useful where one failed."""

    kind: Literal['pool']
    inputs: JobRequestPoolInputs
    parameters: NotRequired[JobRequestPoolParameters]
    priority: NotRequired[int]


class JobRequestPoolInputs(TypedDict):
    # Id or name.
    device: str
    sensor: NotRequired[Literal['gyroscope', 'accelerometer']]
    axis: Literal['x', 'y', 'z']


class JobRequestPoolParameters(TypedDict):
    pass


class JobRequestRegress(TypedDict):
    """Compares stored results of recordings before and after a change of one device: one verdict."""

    kind: Literal['regress']
    inputs: JobRequestRegressInputs
    parameters: NotRequired[JobRequestRegressParameters]
    priority: NotRequired[int]


class JobRequestRegressInputs(TypedDict):
    # Id or name.
    device: str
    # anchor: the label of /v1/regression-anchors. last_pass: the candidate that passed last.
    baseline: NotRequired[JobRequestArm | Literal['anchor', 'last_pass']]
    candidate: JobRequestArm
    # Earlier releases, oldest first; without them those of the device's earlier runs.
    history: NotRequired[list[JobRequestArm]]
    excluded: NotRequired[list[JobRequestRegressInputsExcludedItem]]


class JobRequestRegressInputsExcludedItem(TypedDict):
    recording: str
    reason: str


class JobRequestRegressParameters(TypedDict):
    alpha: NotRequired[float]
    # Per cent of the deviation, at tau to 1 s, to 10 s, above; `sigma` and `slow`: levels of other processes than white
    # noise.
    margin: NotRequired[JobRequestRegressParametersMargin]
    # Scales to here must be shown.
    through_s: NotRequired[float]
    min_edf: NotRequired[float]
    design_power: NotRequired[float]
    # Where facts of the files begin to count.
    event_limits: NotRequired[JobRequestRegressParametersEventLimits]
    # Scatter between sessions [%]: of the device, of an axis, of a scale.
    tau0: NotRequired[JobRequestRegressParametersTau0]
    prior_df: NotRequired[float]
    session_df: NotRequired[int]
    fail_on: NotRequired[Literal['beyond_margin', 'worse']]
    two_sided: NotRequired[bool]
    looks: NotRequired[Literal[1, 3]]
    inconclusive: NotRequired[Literal['inconclusive', 'pass', 'fail']]
    seed: NotRequired[int]


class JobRequestRegressParametersEventLimits(TypedDict):
    """Where facts of the files begin to count."""

    # More missing, frozen or repeated samples than the baseline's largest share [% of the samples].
    missing: NotRequired[float]
    # Times the baseline's largest jitter of the time stamps, and
    jitter: NotRequired[float]
    # of the sample interval [%].
    jitter_of_interval: NotRequired[float]
    # Growth of the step of the values.
    resolution: NotRequired[float]
    # Growth of the rate of bursts of gross errors.
    contamination: NotRequired[float]
    # Candidate sessions in which a cause is identified.
    findings: NotRequired[int]
    # Of the sampling rate [%].
    rate: NotRequired[float]
    # Between the arms [K].
    temperature: NotRequired[float]
    # kL beyond which a rig does not repeat.
    repeatability: NotRequired[float]


class JobRequestRegressParametersMargin(TypedDict):
    """Per cent of the deviation, at tau to 1 s, to 10 s, above; `sigma` and `slow`: levels of other processes than
    white noise."""

    gyroscope: NotRequired[list[float]]
    accelerometer: NotRequired[list[float]]
    sigma: NotRequired[float]
    slow: NotRequired[float]
    # How far a bias may move: gyroscope [deg/s], accelerometer [mg]; 0: it is told and not tested. Needs three sessions
    # an arm.
    bias: NotRequired[JobRequestRegressParametersMarginBias]
    # How far a scale factor may move [ppm]; 0: it is told and not tested. Needs three sessions an arm, each with
    # recordings of an axis under two known inputs.
    scale_factor: NotRequired[JobRequestRegressParametersMarginScaleFactor]


class JobRequestRegressParametersMarginBias(TypedDict):
    """How far a bias may move: gyroscope [deg/s], accelerometer [mg]; 0: it is told and not tested. Needs three
    sessions an arm."""

    gyroscope: NotRequired[float]
    accelerometer: NotRequired[float]


class JobRequestRegressParametersMarginScaleFactor(TypedDict):
    """How far a scale factor may move [ppm]; 0: it is told and not tested. Needs three sessions an arm, each with
    recordings of an axis under two known inputs."""

    gyroscope: NotRequired[float]
    accelerometer: NotRequired[float]


class JobRequestRegressParametersTau0(TypedDict):
    """Scatter between sessions [%]: of the device, of an axis, of a scale."""

    gyroscope: NotRequired[list[float]]
    accelerometer: NotRequired[list[float]]


class JobResult(TypedDict):
    """Where the result is, once the job has succeeded."""

    href: str


class ListDocumentationAnswer(TypedDict):
    pages: list[ListDocumentationAnswerPage]
    problems: list[ListDocumentationAnswerProblem]


class ListDocumentationAnswerPage(TypedDict):
    name: str
    href: str


class ListDocumentationAnswerProblem(TypedDict):
    slug: str
    href: str


class LiveRecording(TypedDict):
    id: str
    device: str
    condition: Condition
    columns: list[str]
    samples: int
    pieces: int
    touched_at: str
    # Only where it was just made.
    token: NotRequired[str]
    # The page that records into it. Only where it was just made.
    href: NotRequired[str]


class Model(TypedDict):
    """Simulation model. What simulators, filters and investigations are given. It never changes; a changed one is a
    child."""

    id: str
    parent: str | None
    device: str | None
    name: str
    processes: ModelProcesses
    channels: NotRequired[ModelChannels]
    deterministic: ModelDeterministic
    effects: ModelEffects
    unnamed: NotRequired[ModelUnnamed]
    # Where it came from. `changes` of a child: what was added to its parent, and why.
    provenance: ModelProvenance
    created_at: str


class ModelChannel(TypedDict):
    processes: ModelProcesses


class ModelDeterministicItem(TypedDict):
    bias: NotRequired[ModelNumber]
    drift: NotRequired[ModelNumber]


class ModelEffect(TypedDict):
    cause: str
    channels: NotRequired[list[str]]
    # Where it acts; left out: everywhere.
    recordings: NotRequired[list[str]]
    params: ModelNumbers


class ModelNumber(TypedDict):
    value: float
    unit: str
    ci95: NotRequired[list[float | None]]


class ModelProcess(TypedDict):
    process: str
    params: ModelNumbers


class ModelProfile(TypedDict):
    # Values are ratios to the model's density or to the power of its white noise; of a mean they are in `unit`.
    kind: Literal['spectrum', 'variance', 'mean']
    # What the profile goes with; a spectrum with frequency, the others with the rest. A phase is the time since the
    # start of the recording, modulo `period_s`.
    against: Literal['frequency', 'time', 'phase', 'rate', 'angular_acceleration', 'temperature', 'warming', 'angle']
    # Of a phase; needed there.
    period_s: NotRequired[float]
    # The unit of the edges: the one that belongs to `against`, whatever is written.
    along: NotRequired[Literal['Hz', 's', 'deg/s', 'deg/s^2', 'degC', 'deg']]
    channel: str
    # Where it acts; left out: everywhere.
    recordings: NotRequired[list[str]]
    edges: list[float]
    values: list[float]
    # Of the values of a mean.
    unit: NotRequired[str]


class ModelProvenance(TypedDict):
    """Where it came from. `changes` of a child: what was added to its parent, and why."""

    made_by: Literal['investigation', 'hand']
    why: NotRequired[str | None]
    investigation: NotRequired[str]
    study: NotRequired[str]
    baseline: NotRequired[dict[str, Any]]
    recordings: NotRequired[list[dict[str, Any]]]
    algorithm_version: NotRequired[int]
    driftlab_version: NotRequired[str]
    changes: NotRequired[list[ModelProvenanceChange]]


class ModelProvenanceChange(TypedDict):
    change: Literal['added']
    cause: str
    status: Literal['identified', 'ambiguous']
    channels: list[str]
    why: str
    # On samples it was not fitted to [nat].
    log_score_per_sample: float | None


class ModelRequest(TypedDict):
    """Simulation model to store. The same document again gives the model that exists."""

    name: str
    # The model that this one changes.
    parent: NotRequired[str]
    # Id or name of a device.
    device: NotRequired[str]
    # What changed, and why.
    why: NotRequired[str]
    processes: ModelProcesses
    channels: NotRequired[ModelChannels]
    deterministic: NotRequired[ModelDeterministic]
    effects: NotRequired[ModelEffects]
    unnamed: NotRequired[ModelUnnamed]


class NewDevice(TypedDict):
    # Not beginning with dev_, and without control characters.
    name: str
    model: NotRequired[str]
    imu: NotRequired[str]
    serial: NotRequired[str]
    labels: NotRequired[dict[str, str]]


class NewDriveEvaluation(TypedDict):
    # Id of a stored drive.
    drive: str
    # In place of the document's.
    model: NotRequired[DriveModel]
    # In place of the document's.
    outages: NotRequired[DriveOutages]
    question: NotRequired[JobRequestDriveQuestionQuestion]
    velocity_constraint: NotRequired[bool]
    zero_velocity: NotRequired[bool]
    odometer: NotRequired[bool]
    gate: NotRequired[float]
    as_stamped: NotRequired[bool]
    seed: NotRequired[int]
    runs: NotRequired[int]
    estimate: NotRequired[bool]
    models: NotRequired[JobRequestDriveQuestionModels]
    fit_noise: NotRequired[bool]
    # 0 is first.
    priority: NotRequired[int]


class NewLiveRecording(TypedDict):
    """A recording as an upload describes it, with the device and with columns that all have a unit; values come in the
    order of the columns."""

    # The user's name of the recording.
    id: NotRequired[str]
    # The file beside the study; an upload carries its bytes itself and ignores it.
    file: NotRequired[str]
    # Samples per second; required without a time column.
    rate_hz: NotRequired[float]
    # Keyed by the file's own column names, or by column number from "0". Columns that are not named are left out, with
    # a note.
    columns: dict[str, RecordingColumn]
    # Of a table with the columns of several units the one that is meant, as its columns begin: `imu2` of `imu2_time
    # (s)`, `imu2_gyro_x (rad/s)`. Beside it no columns but a time are stated.
    stream: NotRequired[str]
    condition: Condition
    # Seconds to leave out at the ends.
    trim: NotRequired[RecordingTrim]
    # The calibration that corrects the readings: in a study on disk a file that `driftlab calibrate --json` wrote, over
    # HTTP the id of a stored one.
    calibration: NotRequired[str]
    # What the recording is called, for example its firmware; regression runs compare by it. No commas, and no = in
    # names.
    labels: NotRequired[dict[str, str]]
    # The power-up of the device that the recording belongs to, under any name.
    session: NotRequired[str]
    # When it began. Without sessions, recordings that begin within ten minutes of the end of another are one session.
    recorded_at: NotRequired[str]
    device: NotRequired[str | RecordingDevice]


class NewOutageEvaluation(TypedDict):
    # A scenario by name, or its document.
    scenario: Literal['paper', 'paper-position-only', 'paper-nhc', 'paper-s-curves'] | OutageScenario
    # Monte Carlo runs at most.
    runs: NotRequired[int]
    seed: NotRequired[int]
    # Stop once every mean error is known to this half-width, relative to it; 0: never.
    relative_precision: NotRequired[float]
    # 0 is first.
    priority: NotRequired[int]


class NewRegressionAnchor(TypedDict):
    # Id or name.
    device: str
    # NAME=VALUE, several with commas between them; recordings of the device have it.
    label: str
    # Why the baseline moves.
    reason: str
    # Settings of a regression run; margins, scope and alpha of them go with the anchor. What is not named stays as it
    # was with the anchor before.
    settings: NotRequired[dict[str, Any]]


class NewToken(TypedDict):
    # What it is for.
    name: str
    scope: Scope
    # Names of the only devices it may know of, which need not exist yet; none for an admin.
    devices: NotRequired[list[str] | None]
    # Seconds until it ends; without, it does not.
    expires_in_s: NotRequired[int]


class NewWebhook(TypedDict):
    # https; plain http and addresses that are not of the Internet only where the daemon was told of them.
    url: str
    description: NotRequired[str]
    # Without: all.
    events: NotRequired[WebhookEvents]


class OutageEvaluation(TypedDict):
    """Outage evaluation. Filters compared through simulated GNSS outages; every filter saw the same data."""

    scenario: OutageScenario
    # What the comparison says; absent from evaluations that were made before they had it.
    summary: NotRequired[RecordingCharacterisationSummary]
    runs: int
    seed: int
    # The precision asked for was reached before the last run.
    stopped_early: bool
    algorithm_version: int
    filters: list[OutageEvaluationFilter]
    # Every pair, in both orders.
    paired: list[OutageEvaluationPair]
    # The gain of M_dyn(GMWM) over M_stat(AV) in parts; null where the scenario lacks the controls.
    attribution: OutageEvaluationAttribution | None
    claims: list[OutageEvaluationClaim]
    trajectory: OutageEvaluationPath
    # Of the truth, one for each outage; those of the filters are in their outages.
    tracks: NotRequired[list[OutageEvaluationTrack]]
    # What stored simulation models say that the scenario does not hold: effects, and biases that a filter is not told.
    left_out: NotRequired[list[OutageEvaluationLeftOutItem]]


class OutageEvaluationAttribution(TypedDict):
    """The gain of M_dyn(GMWM) over M_stat(AV) in parts; null where the scenario lacks the controls."""

    total: OutageEvaluationPair
    low_frequency_noise: OutageEvaluationPair
    gauss_markov_states: OutageEvaluationPair
    switching: OutageEvaluationPair
    switching_av: OutageEvaluationPair


class OutageEvaluationClaim(TypedDict):
    claim: str
    supported: bool
    because: str


class OutageEvaluationFilter(TypedDict):
    name: str
    about: str
    states: int
    mean_error_m: Quantity
    outages: list[OutageEvaluationOutage]
    nees: float
    nees_ci95: list[float | None]
    coverage50: float
    coverage95: float
    heading_rms_deg: float
    tilt_rms_deg: float
    trajectory: OutageEvaluationPath


class OutageEvaluationLeftOutItem(TypedDict):
    where: str
    simulation_model: str
    what: list[str]


class OutageEvaluationMoments(TypedDict):
    """Second moments of the horizontal error and the ellipses of a normal distribution that has them."""

    north_m2: float
    east_m2: float
    north_east_m2: float
    ellipses: list[OutageEvaluationMomentsEllipse]


class OutageEvaluationMomentsEllipse(TypedDict):
    fraction: float
    semi_major_m: float
    semi_minor_m: float
    # From north over east.
    major_axis_azimuth_deg: float


class OutageEvaluationOutage(TypedDict):
    index: int
    start_s: float
    end_s: float
    error_m: Quantity
    rms_m: float
    median_m: float
    p95_m: float
    # Mean of e^T P^-1 e over the runs, two dimensions: 2 where P is right.
    nees: float
    nees_ci95: list[float | None]
    coverage50: float
    coverage95: float
    heading_rms_deg: float
    tilt_rms_deg: float
    mean_error_m: OutageEvaluationOutageMeanErrorM
    predicted: OutageEvaluationMoments
    actual: OutageEvaluationMoments
    # Where the filter believed to be in the first run.
    track: NotRequired[OutageEvaluationTrack]
    # Estimate minus truth in single runs, at most 200.
    errors: OutageEvaluationOutageErrors


class OutageEvaluationOutageErrors(TypedDict):
    """Estimate minus truth in single runs, at most 200."""

    north_m: list[float | None]
    east_m: list[float | None]


class OutageEvaluationOutageMeanErrorM(TypedDict):
    north: float
    east: float


class OutageEvaluationPair(TypedDict):
    """`filter` minus `against`, run by run; negative is better."""

    filter: str
    against: str
    difference_m: Quantity
    relative: Quantity
    outages: list[Quantity]


class OutageEvaluationPartial(TypedDict):
    """What a running evaluation knows: the mean horizontal error at the end of an outage, so far. Only in jobs that
    evaluate outages, and from their first batch of runs on."""

    runs: int
    filters: list[OutageEvaluationPartialFilter]


class OutageEvaluationPartialFilter(TypedDict):
    name: str
    error_m: Quantity


class OutageEvaluationPath(TypedDict):
    """Once a second, metres from the start of the drive."""

    time_s: list[float | None]
    north_m: list[float | None]
    east_m: list[float | None]


class OutageEvaluationResource(TypedDict):
    """Outage evaluation with its result."""

    id: str
    job: OutageEvaluationResourceJob
    scenario_name: str
    runs: int
    seed: int
    relative_precision: float
    state: JobState
    stage: str | None
    progress: float
    created_at: str
    finished_at: str | None
    problem: ProblemStored | None
    # Only while the job runs.
    partial: NotRequired[OutageEvaluationPartial | None]
    evaluation: OutageEvaluation | None


class OutageEvaluationResourceJob(TypedDict):
    href: str


class OutageEvaluationSummary(TypedDict):
    """Outage evaluation without its result."""

    id: str
    job: OutageEvaluationSummaryJob
    scenario_name: str
    runs: int
    seed: int
    relative_precision: float
    state: JobState
    stage: str | None
    progress: float
    created_at: str
    finished_at: str | None
    problem: ProblemStored | None


class OutageEvaluationSummaryJob(TypedDict):
    href: str


class OutageEvaluationTrack(TypedDict):
    """Ten points a second from 10 s before an outage to 10 s after it, metres from the start of the drive; shorter at
    its ends. Absent from evaluations of before it was kept."""

    start_s: float | None
    rate_hz: float
    north_m: list[float | None]
    east_m: list[float | None]


class OutageScenario(TypedDict):
    """Scenario of an outage evaluation. A drive, an inertial unit, a receiver with outages, and the filters that are
    compared. Body axes forward, right, down; angles in deg, rates in deg/s. Members that are not named here are
    refused."""

    name: NotRequired[str]
    about: NotRequired[str]
    # May be left out for a recorded trajectory, which has its own.
    duration_s: NotRequired[float]
    imu_rate_hz: NotRequired[float]
    gnss_rate_hz: NotRequired[float]
    trajectory: OutageScenarioTrajectory
    outages: list[OutageScenarioOutages1Item] | OutageScenarioOutages2
    truth: OutageScenarioTruth
    gnss: NotRequired[OutageScenarioGnss]
    gnss_velocity: NotRequired[Literal['used', 'not used']]
    initial: NotRequired[OutageScenarioInitial]
    non_holonomic: NotRequired[OutageScenarioNonHolonomic]
    filters: list[OutageScenarioFilter]
    # Ignored.
    variants: NotRequired[Any]


class OutageScenarioAxis(TypedDict):
    processes: NotRequired[OutageScenarioModel]
    # A stored fit in place of processes; only over HTTP.
    fit: NotRequired[str]
    # A stored simulation model in place of processes: those of the channel, its drift, and for the truth its bias. What
    # a scenario cannot hold is named in `left_out` of the result. Only over HTTP.
    simulation_model: NotRequired[str]
    # Beside simulation_model: which channel of it; without it gx, gy, gz or fx, fy, fz, or the only one.
    channel: NotRequired[str]
    # Gyroscopes: the models of a device's parameter table by |rate|; only over HTTP. switched: the model of the nearest
    # measured rate; continuous: parameters along their trends.
    table: NotRequired[OutageScenarioAxisTable]
    # Gyroscopes: one model per band of |rate|.
    by_rate: NotRequired[OutageScenarioAxisByRate]
    # Gyroscopes: parameters as continuous functions of |rate| through these points.
    trend: NotRequired[OutageScenarioAxisTrend]
    # Gyroscopes.
    constant_bias_sd_deg_s: NotRequired[float]
    # Accelerometers.
    constant_bias_sd_mg: NotRequired[float]
    # Accelerometers.
    white_noise_mg_per_sqrt_hz: NotRequired[float]
    # Accelerometers.
    in_run: NotRequired[OutageScenarioAxisInRun]


class OutageScenarioAxisByRate(TypedDict):
    """Gyroscopes: one model per band of |rate|."""

    bounds_deg_s: list[float]
    processes: list[OutageScenarioModel]
    hysteresis_deg_s: NotRequired[float]


class OutageScenarioAxisInRun(TypedDict):
    """Accelerometers."""

    process: Literal['gauss_markov']
    sigma_mg: float
    tau_s: float


class OutageScenarioAxisTable(TypedDict):
    """Gyroscopes: the models of a device's parameter table by |rate|; only over HTTP. switched: the model of the
    nearest measured rate; continuous: parameters along their trends."""

    # Id or name.
    device: str
    axis: NotRequired[Literal['x', 'y', 'z']]
    method: NotRequired[Literal['av', 'gmwm']]
    # Without it the one that is best over all rows.
    model: NotRequired[str]
    schedule: NotRequired[Literal['switched', 'continuous']]
    hysteresis_deg_s: NotRequired[float]
    step_deg_s: NotRequired[float]


class OutageScenarioAxisTrend(TypedDict):
    """Gyroscopes: parameters as continuous functions of |rate| through these points."""

    rates_deg_s: list[float]
    processes: list[OutageScenarioModel]
    step_deg_s: NotRequired[float]


class OutageScenarioFilter(TypedDict):
    name: str
    about: NotRequired[str]
    gyro: NotRequired[Literal['white noise, N of Table 1; constant bias',
                              'white noise, N of Tables 1 and 2 by |z reading| through Table 5; constant bias',
                              'WN + 2 GM of Table 4 by |z reading| through Table 5',
                              'WN + 2 GM of Table 4, experiment 0',
                              'N of Table 1; random-walk bias with q = sigma2 sqrt(2 beta2) of experiment 0',
                              'N_eq = sqrt(N^2 + 2 sigma1^2/beta1) of experiment 0; the same random-walk bias'] | OutageScenarioSensor]
    accelerometer: NotRequired[OutageScenarioSensor]
    covariance_samples: NotRequired[int]


class OutageScenarioGnss(TypedDict):
    position_sd_m: NotRequired[list[float]]
    velocity_sd_m_s: NotRequired[list[float]]
    correlated_sd_m: NotRequired[list[float]]
    correlation_time_s: NotRequired[float]
    latency_s: NotRequired[float]
    lever_arm_m: NotRequired[list[float]]
    white: NotRequired[Literal[True]]


class OutageScenarioHardware(TypedDict):
    """Deterministic errors, for all axes or per axis; deg/s or m/s^2."""

    bias: NotRequired[float | list[float]]
    scale_factor: NotRequired[float | list[float]]
    quantization_step: NotRequired[float | list[float]]
    range: NotRequired[float | list[float]]
    bandwidth_hz: NotRequired[float | list[float]]
    misalignment_mrad: NotRequired[list[list[float]]]


class OutageScenarioInitial(TypedDict):
    position_sd_m: NotRequired[list[float]]
    velocity_sd_m_s: NotRequired[list[float]]
    tilt_sd_deg: NotRequired[float]
    heading_sd_deg: NotRequired[float]
    # Of filters that are named by a published sentence.
    gyro_bias_sd_deg_s: NotRequired[float]
    filters_without_gm_states_add_slow_gm_to_initial_bias_sd: NotRequired[Literal[True]]


class OutageScenarioModelItem(TypedDict):
    process: Literal['white_noise', 'gauss_markov', 'random_walk', 'linear_drift', 'quantization_noise',
                     'flicker_noise', 'sinusoid', 'resonance', 'low_pass_1', 'low_pass_2', 'moving_average',
                     'decimation', 'power_law']
    # As in the `processes` of a fit; a number alone is SI.
    params: dict[str, float | OutageScenarioModelItemParam2]


class OutageScenarioModelItemParam2(TypedDict):
    value: float
    unit: str
    ci95: NotRequired[list[Any]]


class OutageScenarioNonHolonomic(TypedDict):
    rate_hz: NotRequired[float]
    sd_m_s: NotRequired[float]


class OutageScenarioOutages1Item(TypedDict):
    start_s: float
    duration_s: float


class OutageScenarioOutages2(TypedDict):
    """One over each turn."""

    start: Literal['turn onset']
    duration_s: float
    error_scored: NotRequired[str]


class OutageScenarioPublishedGyro(TypedDict):
    model: Literal['Table 4, iPhone 5S, every axis']
    condition: NotRequired[Literal['z by true |rate| through Table 5, x and y at experiment 0']]
    constant_bias_sd_deg_s: NotRequired[float]


class OutageScenarioSegment(TypedDict):
    # Start; segments stand in this order. Turns add where they overlap; a change of speed begins after the one before
    # it has ended.
    t_s: float
    kind: Literal['straight', 'turn', 'accelerate', 's_curve', 'stop']
    # turn, s_curve: positive to the right.
    rate_deg_s: NotRequired[float]
    # turn; each half of an s_curve.
    duration_s: NotRequired[float]
    # accelerate, stop: magnitude.
    m_s2: NotRequired[float]
    # accelerate.
    until_speed_m_s: NotRequired[float]


class OutageScenarioSensor2(TypedDict):
    x: OutageScenarioAxis
    y: OutageScenarioAxis
    z: OutageScenarioAxis


class OutageScenarioTrajectory(TypedDict):
    start: NotRequired[OutageScenarioTrajectoryStart]
    # Rates and accelerations rise and fall over this time; a turn keeps its angle.
    ramp_s: NotRequired[float]
    segments_by_start_time: NotRequired[list[OutageScenarioSegment]]
    # Lists of one length. Without angles the vehicle looks where it goes.
    recorded: NotRequired[OutageScenarioTrajectoryRecorded]


class OutageScenarioTrajectoryRecorded(TypedDict):
    """Lists of one length. Without angles the vehicle looks where it goes."""

    time_s: list[float]
    velocity_ned_m_s: list[list[float]]
    roll_deg: NotRequired[list[float]]
    pitch_deg: NotRequired[list[float]]
    heading_deg: NotRequired[list[float]]


class OutageScenarioTrajectoryStart(TypedDict):
    speed_m_s: NotRequired[float]
    heading_deg: NotRequired[float]
    latitude_deg: NotRequired[float]
    longitude_deg: NotRequired[float]
    height_m: NotRequired[float]


class OutageScenarioTruth(TypedDict):
    gyro: OutageScenarioPublishedGyro | OutageScenarioSensor
    accelerometer: OutageScenarioSensor
    gyro_errors: NotRequired[OutageScenarioHardware]
    accelerometer_errors: NotRequired[OutageScenarioHardware]


class ParameterTable(TypedDict):
    """Parameter table. One sensor axis of one device: a row per dynamic condition, a column per parameter."""

    # The user's name of the device.
    device: str
    sensor: Literal['gyroscope', 'accelerometer', 'sensor']
    axis: str | None
    method: Literal['av', 'gmwm']
    # The one model of all rows; null for method av.
    model: str | None
    # The condition of the row that the others are compared with, in its compact form.
    reference: str | None
    structure: NotRequired[PooledSensorStructure]
    # How the model of the table and the structure of the statement are both right; null where they are one.
    model_note: str | None
    pooling: ParameterTablePooling
    summary: NotRequired[RecordingCharacterisationSummary]
    data_sheet: NotRequired[ParameterTableSheetComparison]
    columns: list[ParameterTableColumn]
    rows: list[ParameterTableRow]


class ParameterTableCell(TypedDict):
    value: float
    unit: str
    ci95: list[float | None]
    # Against the row of the reference; null for that row and where an interval is open.
    change: Literal['up', 'down', 'none', None]
    # To the row of the reference; null for that row and where it has no value. The interval is that of two independent
    # values.
    ratio: Quantity | None


class ParameterTableColumn(TypedDict):
    key: str
    # Also where no row identifies the parameter; null where the unit of the channel is not known.
    unit: str | None


class ParameterTablePooling(TypedDict):
    """Whether the recordings are put together as far as they go. A job of kind pool fits those of one condition
    jointly; until it has ended their values are averaged."""

    # pending: the table will change, and `Prefer: wait` waits for it. Method av takes nothing from joint fits and is
    # always done.
    state: Literal['done', 'pending', 'failed']
    # null where there is nothing to pool.
    job: str | None
    # Why it failed; a job of kind pool asks for it again.
    reason: str | None


class ParameterTableRow(TypedDict):
    condition: Condition
    label: str
    # The worst verdict of the recordings of the row.
    contamination: NotRequired[Literal['clean', 'undecided', 'contaminated', None]]
    # What the fits shown say against themselves.
    warnings: NotRequired[list[str]]
    recordings: list[str]
    # Of all recordings of the row, as analysed.
    duration_s: float
    # Whether the J test lets the one fit of the row stand (p of 0.01 or more); null where several are averaged, for
    # method av, and where too few scales are left to test.
    fits: bool | None
    # Its p.
    j_test_p: float | None
    # One recording; replicates averaged from their intervals; replicates fitted jointly.
    pooling: NotRequired[Literal['single', 'average', 'joint']]
    # The values come from robust variances.
    robust: NotRequired[bool]
    agreement: NotRequired[PooledSensorAgreement | None]
    # N, the root of the density of rate at low frequencies (angle or velocity random walk), whatever the model; null
    # where no model describes the curve.
    density: NotRequired[ParameterTableCell | None]
    # Keyed by column; null where the parameter is not identifiable.
    values: dict[str, ParameterTableCell | None]
    # Why a value is null.
    reasons: dict[str, str]
    # The same in a word. not_identifiable: the data are compatible with none of it, or do not bound it; none_found: the
    # best fit has none of it.
    why: dict[str, Literal['not_identifiable', 'none_found']]


class ParameterTableSheetComparison(TypedDict):
    """The first row against the data sheet of the sensor; absent where the sensor is not known or not at rest there."""

    sensor: str
    source: str
    # Of the row that is compared, for people.
    condition: str
    figures: list[ParameterTableSheetComparisonFigure]


class ParameterTableSheetComparisonFigure(TypedDict):
    parameter: Literal['N', 'B']
    # Comparable to what is measured: N two-sided, B the least Allan deviation over 0.664.
    stated: float
    unit: str
    # null where it is not identified.
    measured: Quantity | None
    # Measured over stated.
    ratio: float | None
    # Of the ratio.
    ci95: list[float | None] | None
    # agrees: the interval of the ratio reaches between 1/1.5 and 1.5.
    verdict: Literal['agrees', 'above', 'below', None]


class ParameterTables(TypedDict):
    """The tables of every axis of a sensor that has results."""

    device: str
    sensor: Literal['gyroscope', 'accelerometer', 'sensor']
    method: Literal['av', 'gmwm']
    tables: list[ParameterTable]


class PooledSensor(TypedDict):
    """Pooled sensor axis. The recordings of one sensor axis put together: replicates fitted jointly, their agreement,
    and the model structure over all conditions."""

    # Its id; of the result of a pool job.
    device: NotRequired[str]
    quantity: str
    axis: str | None
    # The column name in the first recording.
    channel: NotRequired[str | None]
    # The axis, or the column name of a channel that has none.
    sensor_axis: NotRequired[str]
    # The structure with the smallest sum of the criterion over all conditions.
    model: str | None
    # Why nothing could be put together.
    reason: NotRequired[str]
    structure: PooledSensorStructure | None
    conditions: list[PooledSensorCondition]


class PooledSensorAgreement(TypedDict):
    # Of the joint fit; null for averages.
    model: NotRequired[str | None]
    statistic: float | None
    dof: float | None
    p: float | None
    # p is 0.05 or more.
    agree: bool


class PooledSensorCondition(TypedDict):
    condition: Condition
    # The condition in one word.
    key: NotRequired[str]
    label: str
    recordings: list[str]
    # The results it was made of.
    members: NotRequired[list[str]]
    contamination: NotRequired[Literal['clean', 'undecided', 'contaminated', None]]
    # A recording with gross errors took part with its robust variances.
    robust: bool
    agreement: PooledSensorAgreement | None
    best: int | None
    # Why the recordings of the condition have no joint fit; left out where they have one.
    reason: NotRequired[str]
    fits: list[FitModelFit]


class PooledSensorStructure(TypedDict):
    """Whether one structure serves every condition."""

    verdict: Literal['one_structure', 'changes', 'undecided']
    statement: str
    # The smallest structure that serves every condition, whole or in part.
    common: str
    # That the common structure fits every condition.
    p: float | None
    statistic: NotRequired[float | None]
    dof: NotRequired[float | None]
    # By how much its criterion exceeds the best in the condition that shows it best; above 6 the structure changes.
    excess: float | None
    # By the criterion summed over the conditions, the best first; null where a condition lacks a fit.
    ranking: list[PooledSensorStructureRankingItem]
    # The best of each condition.
    by_condition: list[PooledSensorStructureByConditionItem]


class PooledSensorStructureByConditionItem(TypedDict):
    label: str
    model: str


class PooledSensorStructureRankingItem(TypedDict):
    model: str
    criterion: float | None


class Population(TypedDict):
    """Populations of a model. All devices of a model: one population for each sensor axis, condition and parameter."""

    model: str
    # Which devices are not of the line, or that none stands out.
    summary: RecordingCharacterisationSummary
    # Names of the devices that have results.
    devices: list[str]
    rows: list[PopulationPopulation]
    # Every flag again, as a list to watch.
    outlying: list[PopulationOutlyingItem]


class PopulationOutlyingItem(TypedDict):
    device: str
    sensor: Literal['gyroscope', 'accelerometer']
    axis: str | None
    label: str
    parameter: Literal['N', 'B', 'K']


class PopulationPlace(TypedDict):
    device: str
    estimate: Quantity
    # Distance from the mean over spread and own error, on the log scale.
    z: float
    # Share of such estimates below it, by the other devices; null with fewer than four.
    quantile: float | None
    # Two-sided, leave-one-out.
    p: float | None
    # Corrected over the devices.
    p_holm: float | None
    # p_holm below 0.05.
    outlying: bool


class PopulationPopulation(TypedDict):
    sensor: Literal['gyroscope', 'accelerometer']
    axis: str | None
    condition: Condition
    # The condition for people.
    label: str
    parameter: Literal['N', 'B', 'K']
    # Random-effects mean with its 95 % interval; null with fewer than two devices.
    mean: Quantity | None
    # tau: standard deviation of the logarithm between devices.
    spread: float | None
    # 95 % of further devices lie here; null with fewer than three.
    prediction: list[float] | None
    # Cochran's Q: that all devices share one value.
    heterogeneity: PopulationPopulationHeterogeneity | None
    # Why there is no mean.
    reason: str | None
    places: list[PopulationPlace]
    left_out: list[PopulationPopulationLeftOutItem]


class PopulationPopulationHeterogeneity(TypedDict):
    """Cochran's Q: that all devices share one value."""

    q: float
    dof: int
    p: float


class PopulationPopulationLeftOutItem(TypedDict):
    device: str
    reason: str


class Problem(TypedDict):
    """Problem document (RFC 9457). The body of every answer from 400 up."""

    # A page that says what this means and what to do.
    type: str
    title: str
    status: int
    # One sentence about this case.
    detail: str
    # The last part of `type` with underscores.
    code: str
    # Whether the same request may succeed later.
    retryable: bool
    # What is at fault: row, column, parameter, part, byte, ...
    where: NotRequired[dict[str, str | int]]
    # Every fault of a JSON body.
    errors: list[ProblemError]
    instance: str
    request_id: str


class ProblemError(TypedDict):
    # JSON Pointer (RFC 6901); the empty one is the document.
    pointer: str
    code: str
    detail: str


class ProblemStored(TypedDict):
    """The problem of a job: without the request that asked."""

    type: str
    title: str
    status: int
    detail: str
    code: str
    retryable: bool
    where: NotRequired[dict[str, str | int]]
    errors: ProblemErrors


class Quantity(TypedDict):
    """Quantity with unit and 95 % interval."""

    value: float
    unit: str
    ci95: list[float | None]


class ReadinessAnswer(TypedDict):
    status: Literal['ready']
    # Stored files that are damaged and could not be healed; the log names them.
    damaged_files: NotRequired[int]
    # A sentence, where a newer driftlab has brought the database to a schema beside which this one works on.
    newer_schema: NotRequired[str]
    # What is wrong now. Each begins and ends once in the log and in the audit log.
    states: NotRequired[list[ReadinessAnswerState]]


class ReadinessAnswerState(TypedDict):
    state: Literal['store_silent', 'store_unwritable', 'blobs_silent', 'disk_nearly_full', 'files_fail', 'file_damaged',
                   'row_damaged', 'backups_fail', 'writes_lost']
    cause: Literal['io', 'disk_full', 'damage']
    since: str
    detail: str
    # SHA-256 of the file as it was uploaded.
    file: NotRequired[str]
    # The row that is damaged, as `table/key`.
    row: NotRequired[str]


class Recording(TypedDict):
    """Recording, as a user describes it. What the columns of a file measure, how fast it was sampled, and under which
    condition: one member of `recordings` of a study. Members that are not named here are refused."""

    # The user's name of the recording.
    id: NotRequired[str]
    # The file beside the study; an upload carries its bytes itself and ignores it.
    file: NotRequired[str]
    # Samples per second; required without a time column.
    rate_hz: NotRequired[float]
    # Keyed by the file's own column names, or by column number from "0". Columns that are not named are left out, with
    # a note.
    columns: NotRequired[dict[str, RecordingColumn]]
    # Of a table with the columns of several units the one that is meant, as its columns begin: `imu2` of `imu2_time
    # (s)`, `imu2_gyro_x (rad/s)`. Beside it no columns but a time are stated.
    stream: NotRequired[str]
    condition: Condition
    # Seconds to leave out at the ends.
    trim: NotRequired[RecordingTrim]
    # The calibration that corrects the readings: in a study on disk a file that `driftlab calibrate --json` wrote, over
    # HTTP the id of a stored one.
    calibration: NotRequired[str]
    # What the recording is called, for example its firmware; regression runs compare by it. No commas, and no = in
    # names.
    labels: NotRequired[dict[str, str]]
    # The power-up of the device that the recording belongs to, under any name.
    session: NotRequired[str]
    # When it began. Without sessions, recordings that begin within ten minutes of the end of another are one session.
    recorded_at: NotRequired[str]


class RecordingChange(TypedDict):
    # The user's name of the recording, not its id here.
    id: NotRequired[str | None]
    rate_hz: NotRequired[float | None]
    columns: NotRequired[RecordingMembersColumns | None]
    stream: NotRequired[str | None]
    condition: NotRequired[Condition]
    trim: NotRequired[RecordingMembersTrim | None]
    calibration: NotRequired[str | None]
    labels: NotRequired[dict[str, str] | None]
    session: NotRequired[str | None]
    recorded_at: NotRequired[str | None]


class RecordingCharacterisation(TypedDict):
    """Newest result of a recording. What the newest characterisation of one recording found, what it says in a
    sentence, and what its best fit implies."""

    recording: str
    # The recording's revision that was characterised.
    revision: int
    # The recording has changed since.
    stale: bool
    job: str
    created_at: str
    algorithm_version: int
    parameters: JobRequest
    condition: Condition
    duration_s: float
    rate_hz: float
    channels: list[RecordingCharacterisationChannel]


class RecordingCharacterisationChannel(TypedDict):
    summary: RecordingCharacterisationSummary
    # Of each of the result's `fits`, in their order; empty text where a fit is not kept.
    fit_ids: list[str]
    # By the best fit; null where it leaves a parameter open.
    implied: RecordingCharacterisationImplied | None
    result: CharacterisationChannel


class RecordingCharacterisationImplied(TypedDict):
    """What a fit implies of the curves beside the measured ones, as a whole and process by process; independent
    processes add in variance and density."""

    # The channel's own unit.
    unit: str
    # Allan deviation [unit]; the Haar wavelet deviation is this over the square root of 2.
    allan: RecordingCharacterisationImpliedAllan
    # Two-sided density [unit^2/Hz]; null where a process has none.
    spectrum: RecordingCharacterisationImpliedSpectrum
    # At the times that were measured: the implied Allan deviation, and the measured one over it with its interval.
    ratio: RecordingCharacterisationImpliedRatio


class RecordingCharacterisationImpliedAllan(TypedDict):
    """Allan deviation [unit]; the Haar wavelet deviation is this over the square root of 2."""

    tau_s: list[float | None]
    deviation: list[float | None]
    components: list[RecordingCharacterisationImpliedAllanComponent]


class RecordingCharacterisationImpliedAllanComponent(TypedDict):
    process: str
    deviation: list[float | None]


class RecordingCharacterisationImpliedRatio(TypedDict):
    """At the times that were measured: the implied Allan deviation, and the measured one over it with its interval."""

    tau_s: list[float | None]
    deviation: list[float | None]
    measured_over_model: list[float | None]
    ci95: list[list[float | None]]


class RecordingCharacterisationImpliedSpectrum(TypedDict):
    """Two-sided density [unit^2/Hz]; null where a process has none."""

    f_hz: list[float | None]
    density: list[float | None]
    components: list[RecordingCharacterisationImpliedSpectrumComponent]


class RecordingCharacterisationImpliedSpectrumComponent(TypedDict):
    process: str
    density: list[float | None]


class RecordingCharacterisationSummary(TypedDict):
    """A sentence that a person could act on, with its evidence. Command line, API and page say the same."""

    verdict: str
    details: list[str]
    # look: something that a reader must know first; wrong: not to be used as it is.
    level: Literal['fine', 'look', 'wrong']
    # What the sentence rests on: JSON pointers into the document it is about.
    facts: list[RecordingCharacterisationSummaryFact]


class RecordingCharacterisationSummaryFact(TypedDict):
    pointer: str
    value: float | None


class RecordingColumn(TypedDict):
    quantity: Literal['time', 'angular_rate', 'specific_force', 'temperature', 'reference_angular_rate',
                      'reference_specific_force', 'reference_angle', 'magnetic_field', 'gnss_position', 'gnss_velocity',
                      'reference_position', 'reference_velocity', 'reference_attitude']
    # x, y, z; lat, lon, height or north, east, down for positions; north, east, down for velocities; roll, pitch, yaw
    # for attitudes.
    axis: NotRequired[str]
    # A unit that measures the quantity; without one the channel has the unit 1, with a note.
    unit: NotRequired[str]


class RecordingDevice(TypedDict):
    # The user's name of the device, or its id.
    id: str
    model: NotRequired[str]
    imu: NotRequired[str]
    serial: NotRequired[str]


class RecordingMembers(TypedDict):
    # The user's name of the recording.
    id: NotRequired[str]
    # The file beside the study; an upload carries its bytes itself and ignores it.
    file: NotRequired[str]
    # Samples per second; required without a time column.
    rate_hz: NotRequired[float]
    # Keyed by the file's own column names, or by column number from "0". Columns that are not named are left out, with
    # a note.
    columns: NotRequired[dict[str, RecordingColumn]]
    # Of a table with the columns of several units the one that is meant, as its columns begin: `imu2` of `imu2_time
    # (s)`, `imu2_gyro_x (rad/s)`. Beside it no columns but a time are stated.
    stream: NotRequired[str]
    condition: Condition
    # Seconds to leave out at the ends.
    trim: NotRequired[RecordingTrim]
    # The calibration that corrects the readings: in a study on disk a file that `driftlab calibrate --json` wrote, over
    # HTTP the id of a stored one.
    calibration: NotRequired[str]
    # What the recording is called, for example its firmware; regression runs compare by it. No commas, and no = in
    # names.
    labels: NotRequired[dict[str, str]]
    # The power-up of the device that the recording belongs to, under any name.
    session: NotRequired[str]
    # When it began. Without sessions, recordings that begin within ten minutes of the end of another are one session.
    recorded_at: NotRequired[str]


class RecordingPreview(TypedDict):
    """Preview of a recording. What the beginning of a file would be as a recording; nothing is kept."""

    # null where no format is recognised.
    format: str | None
    compression: Literal['none', 'gzip', 'xz', 'zstd']
    # The bytes were all of the file.
    whole_file: bool
    # Rows that were decoded, 20000 at most.
    rows_seen: int
    # In file order, with what an upload would take them to mean; empty where the format tells its columns at the end of
    # the file.
    columns: list[RecordingPreviewColumn]
    rate_hz: RecordingPreviewRateHz | None
    # A column that rises evenly, as a time does, though nothing calls it one or says its unit.
    time_guess: RecordingPreviewTimeGuess | None
    # The condition that the readings show; null where they show none.
    condition_guess: RecordingPreviewConditionGuess | None
    # Sentences that speak against a unit.
    hints: list[str]
    # What the upload would be refused for.
    problems: list[RecordingPreviewProblem]
    # What was left out, renamed or assumed.
    notes: list[str]


class RecordingPreviewColumn(RecordingPreviewColumnOdd):
    name: str
    # null for a column that would not be read.
    quantity: str | None
    axis: str | None
    # null where nobody states it.
    unit: str | None
    # Its first values; null where one is missing.
    first: list[float | None]
    # Values spread over the rows seen.
    course: list[float | None]


class RecordingPreviewConditionGuess(TypedDict):
    """The condition that the readings show; null where they show none."""

    condition: Condition
    # Its compact form.
    text: str
    because: str


class RecordingPreviewProblem(TypedDict):
    code: str
    detail: str
    # Where: `column`, `row`, `parameter`.
    fields: dict[str, str]


class RecordingPreviewRateHz(RecordingPreviewRateHzOdd):
    value: float


class RecordingPreviewTimeGuess(TypedDict):
    """A column that rises evenly, as a time does, though nothing calls it one or says its unit."""

    column: str
    unit: str
    rate_hz: float


class RecordingTrim(TypedDict):
    """Seconds to leave out at the ends."""

    start_s: NotRequired[float]
    end_s: NotRequired[float]


class RecordingUploadMetadata(TypedDict):
    """Metadata of an upload. A recording and the device that made it."""

    # The user's name of the recording.
    id: NotRequired[str]
    # The file beside the study; an upload carries its bytes itself and ignores it.
    file: NotRequired[str]
    # Samples per second; required without a time column.
    rate_hz: NotRequired[float]
    # Keyed by the file's own column names, or by column number from "0". Columns that are not named are left out, with
    # a note.
    columns: NotRequired[dict[str, RecordingColumn]]
    # Of a table with the columns of several units the one that is meant, as its columns begin: `imu2` of `imu2_time
    # (s)`, `imu2_gyro_x (rad/s)`. Beside it no columns but a time are stated.
    stream: NotRequired[str]
    condition: Condition
    # Seconds to leave out at the ends.
    trim: NotRequired[RecordingTrim]
    # The calibration that corrects the readings: in a study on disk a file that `driftlab calibrate --json` wrote, over
    # HTTP the id of a stored one.
    calibration: NotRequired[str]
    # What the recording is called, for example its firmware; regression runs compare by it. No commas, and no = in
    # names.
    labels: NotRequired[dict[str, str]]
    # The power-up of the device that the recording belongs to, under any name.
    session: NotRequired[str]
    # When it began. Without sessions, recordings that begin within ten minutes of the end of another are one session.
    recorded_at: NotRequired[str]
    device: NotRequired[str | RecordingDevice]


class Regression(TypedDict):
    """Regression run. Whether the noise of a device is no worse than before a change: verdict, what it rests on, and
    every test."""

    id: NotRequired[str]
    device: str
    verdict: RegressionVerdict
    lean: Literal['worse', None]
    summary: RegressionSummary
    # Largest averaging time to which all axes are gated.
    scope_s: float
    # As asked, with defaults filled in.
    settings: RegressionSettings
    arms: RegressionArms
    # What a session adds, as factors of its prior scatter: kL of what all scales of an axis and all axes of the device
    # have in common, kS of what is local to a scale.
    between: RegressionBetween | None
    critical: RegressionCritical
    # Margins, scope and alpha that are kept with the anchor where it is the baseline, and what this run does otherwise.
    kept: RegressionKept | None
    look: RegressionLook
    units: list[RegressionUnit]
    findings: list[RegressionFinding]
    # Every item that must agree, in each way in which it does not.
    comparability: list[RegressionComparabilityItem]
    needs: RegressionNeeds
    # Drift over three releases or more: the scales to through_s, and N, regressed on the order of the releases. Ratios
    # of deviations.
    trend: list[RegressionTrendItem]
    versus_previous: RegressionVersusPrevious | None
    algorithm_version: int


class RegressionAnchor(TypedDict):
    id: str
    device: str
    label: str
    reason: str
    # Margins, scope and alpha that runs against it have unless they name others; null for an anchor of before they were
    # kept.
    settings: dict[str, Any] | None
    created_at: str


class RegressionArm(TypedDict):
    label: str | None
    sessions: list[RegressionArmSession]
    # Of all recordings, each once, rising.
    rates_hz: list[float]
    # Sessions of several recordings, which count once.
    merged: list[str]


class RegressionArmSession(TypedDict):
    session: str
    recordings: list[str]
    duration_s: float


class RegressionArms(TypedDict):
    baseline: RegressionArm
    candidate: RegressionArm
    history: list[RegressionArm]
    excluded: list[RegressionArmsExcludedItem]


class RegressionArmsExcludedItem(TypedDict):
    recording: str
    reason: str


class RegressionBetween(TypedDict):
    """What a session adds, as factors of its prior scatter: kL of what all scales of an axis and all axes of the device
    have in common, kS of what is local to a scale."""

    kL: RegressionFactor
    kS: RegressionFactor
    factors: list[float]
    posterior: list[list[float]]
    contrasts: int
    # Those that inform the factors: of arms and releases with more than one.
    sessions: list[RegressionBetweenSession]
    t_d: RegressionScatter
    t_a: RegressionScatter
    t_s: RegressionScatter


class RegressionBetweenSession(TypedDict):
    label: str | None
    session: str


class RegressionComparabilityItem(TypedDict):
    item: Literal['unit', 'temperature', 'full_scale', 'length', 'repeatability']
    comparable: bool
    # Why not.
    sentence: str | None


class RegressionCritical(TypedDict):
    c_max: NotRequired[float]
    c_1: NotRequired[float]
    draws: NotRequired[int]
    seed: NotRequired[int]


class RegressionFactor(TypedDict):
    value: NotRequired[float]
    ci95: NotRequired[list[float]]


class RegressionFinding(TypedDict):
    check: Literal['saturation', 'missing', 'frozen', 'repeated', 'timestamps', 'resolution', 'contamination',
                   'findings', 'rate', 'bias', 'scale_factor', 'time_base']
    verdict: Literal['ok', 'note', 'fail']
    sentence: str | None
    sessions: list[str]
    p: float | None


class RegressionKept(TypedDict):
    """Margins, scope and alpha that are kept with the anchor where it is the baseline, and what this run does
    otherwise."""

    settings: dict[str, Any]
    changed: list[RegressionKeptChangedItem]


class RegressionKeptChangedItem(TypedDict):
    setting: str
    kept: str
    now: str


class RegressionLook(TypedDict):
    number: NotRequired[int]
    of: NotRequired[int]
    counted: NotRequired[bool]
    share: NotRequired[float]


class RegressionNeeds(TypedDict):
    sessions_per_arm: int | None
    length_s: float | None
    sentence: str | None


class RegressionRun(TypedDict):
    """Regression run in a list."""

    # Of the run and of its job.
    id: str
    state: JobState
    # Its id.
    device: str | None
    device_name: str | None
    # Label.
    baseline: str | None
    # Label.
    candidate: str | None
    verdict: Literal['pass', 'fail', 'inconclusive', None]
    summary: RegressionSummary | None
    look: int | None
    needs: RegressionNeeds | None
    # The test that shows the candidate furthest beyond its margin.
    worst: RegressionRunWorst | None
    # The tests of the parameter that was asked for, one for each axis and condition that has it; none of a run that did
    # not compare it. Only with `parameter`.
    parameters: NotRequired[list[RegressionRunParameter]]
    # How much sessions scatter, in units of what is expected: of all axes in common, and of scales.
    between: RegressionRunBetween | None
    created_at: str


class RegressionRunBetween(TypedDict):
    """How much sessions scatter, in units of what is expected: of all axes in common, and of scales."""

    kL: RegressionRunFactor
    kS: RegressionRunFactor


class RegressionRunFactor(TypedDict):
    value: float
    ci95: list[float]


class RegressionRunParameter(TypedDict):
    sensor: str
    axis: str
    condition: str
    name: str
    # Candidate over baseline.
    ratio: float | None
    ci: list[float | None]
    margin: float
    gated: bool
    verdict: str


class RegressionRunWorst(TypedDict):
    """The test that shows the candidate furthest beyond its margin."""

    sensor: str
    axis: str
    kind: Literal['scale', 'parameter']
    tau_s: NotRequired[float]
    name: NotRequired[str]
    # Candidate over baseline, of deviations.
    ratio: float
    ci: list[float | None]
    margin: float
    gated: bool
    verdict: str


class RegressionScatter(TypedDict):
    """Prior scatter between sessions [% of the deviation]: t_d of the device, t_a of an axis, t_s of a scale."""

    gyroscope: float
    accelerometer: float


class RegressionSettings(TypedDict):
    """As asked, with defaults filled in."""

    # Where each setting comes from: asked in the run, kept with the anchor, or the default.
    origin: dict[str, Literal['asked', 'anchor', 'default']]
    alpha: NotRequired[float]
    margin: NotRequired[dict[str, Any]]
    through_s: NotRequired[float]
    min_edf: NotRequired[float]
    design_power: NotRequired[float]
    tau0: NotRequired[dict[str, Any]]
    prior_df: NotRequired[float]
    session_df: NotRequired[int]
    fail_on: NotRequired[Literal['worse', 'beyond_margin']]
    two_sided: NotRequired[bool]
    looks: NotRequired[int]
    event_limits: NotRequired[dict[str, Any]]
    seed: NotRequired[int]


class RegressionSummary(TypedDict):
    verdict: str
    details: list[str]
    level: Literal['fine', 'look', 'wrong']
    facts: list[dict[str, Any]]


class RegressionTest(TypedDict):
    kind: Literal['scale', 'parameter']
    tau_s: NotRequired[float]
    name: NotRequired[str]
    # Allan deviation of the arm at this averaging time, over its sessions; its interval is of this one alone.
    baseline: NotRequired[Quantity]
    candidate: NotRequired[Quantity]
    # Candidate over baseline, of the deviation.
    ratio: float
    # Holds for all tests at once.
    ci: list[float]
    # Upper limit of this test alone.
    upper_single: float
    # The greatest ratio that is tolerated: 1.1 where 10 % are.
    margin: float
    gated: bool
    verdict: Literal['ok', 'worse_within_margin', 'beyond', 'open', 'improved']
    # That unchanged noise shows this much beyond the margin anywhere.
    p_adjusted: float


class RegressionTrendItem(TypedDict):
    unit: str
    of: str
    releases: int
    per_release: float
    ci95: list[float]
    # From the baseline to the candidate.
    total: float
    p: float
    # p below 0.01.
    warning: bool


class RegressionUnit(TypedDict):
    device: str
    condition: str
    sensor: Literal['gyroscope', 'accelerometer']
    axis: str
    # An arm has gross errors: both are compared by robust variances.
    robust: bool
    edf: RegressionUnitEdf
    structure: RegressionUnitStructure
    tests: list[RegressionTest]


class RegressionUnitEdf(TypedDict):
    tau_s: NotRequired[list[float]]
    baseline: NotRequired[list[float]]
    candidate: NotRequired[list[float]]


class RegressionUnitStructure(TypedDict):
    baseline: NotRequired[str | None]
    candidate: NotRequired[str | None]
    pooled: NotRequired[str | None]
    # Parameters are not compared; scales decide.
    changed: NotRequired[bool]
    p: NotRequired[float]


class RegressionVersusPrevious(TypedDict):
    label: NotRequired[str]
    verdict: NotRequired[RegressionVerdict]
    sentence: NotRequired[str]


class SearchItem(TypedDict):
    kind: Literal['device', 'recording', 'job', 'model', 'investigation']
    id: str
    title: str
    subtitle: str
    href: str


class SensorSheet(TypedDict):
    """The figures of the gyroscope or the accelerometer."""

    sensor: Literal['gyroscope', 'accelerometer']
    unit: str
    # Table or section of the document.
    place: str
    full_scales: list[SensorSheetFullScale]
    noise_density: NotRequired[StatedFigure]
    noise_density_z: NotRequired[StatedFigure]
    random_walk: NotRequired[StatedFigure]
    bias_stability: NotRequired[StatedFigure]
    N: NotRequired[StatedFigure]
    # Lowest and highest, -3 dB.
    bandwidth_hz: NotRequired[list[float]]
    # Lowest and highest output rate.
    rate_hz: NotRequired[list[float]]


class SensorSheetFullScale(TypedDict):
    # Readings from -limit to limit.
    limit: float
    # What one count means.
    per_count: NotRequired[float]


class Session(TypedDict):
    # How the request was admitted.
    authentication: Literal['off', 'token', 'session']
    # The public id of the token.
    token: str | None
    name: str | None
    scope: Scope
    # The only devices there are for it; null: all.
    devices: list[str] | None


class Spectrogram(TypedDict):
    """Spectrogram. The density of a channel's error series in time and frequency over the density expected: of a fitted
    model, or the median over time of each frequency."""

    unit: str
    dt_s: float
    samples: int
    first_s: float
    expected: Literal['model', 'median']
    # Middle of each cell since the first sample looked at.
    time_s: list[float]
    # Mean frequency of each band, rising.
    f_hz: list[float]
    # One row per time, one number per band: 0 as expected, 1 ten times as much.
    log10_ratio: list[list[float | None]]
    window_samples: int


class Spectrum(TypedDict):
    """Spectrum. The power spectral density of a channel's error series, two-sided, in the bins that were asked for. Of
    a channel with gaps: of its longest run without one."""

    # Of the channel; densities are in its square over Hz.
    unit: str
    dt_s: float
    # Looked at.
    samples: int
    # Time of the first of them since the first of the file.
    first_s: float
    # Mean of the Fourier frequencies of each bin, rising.
    f_hz: list[float]
    # Mean over the bin.
    density: list[float | None]
    # Chi-square, for Gaussian noise.
    ci95: list[list[float | None]]
    # The greatest ordinate of the bin: a line that the mean hides.
    max: list[float | None]
    segments: int
    segment_samples: int
    window: str


class StatedFigure(TypedDict):
    """A figure as it is stated; `N` is what a measured N compares with."""

    value: float
    unit: str


class StoredDrive(TypedDict):
    """Stored drive. A drive document over uploaded recordings of one device."""

    id: str
    device: str
    # The document's own id.
    name: str
    vehicle: str
    drive: Drive
    created_at: str


class StoredRecording(TypedDict):
    """Stored recording."""

    id: str
    device: str
    # Grows when the metadata change; results name it.
    revision: int
    metadata: Recording
    quality: StoredRecordingQuality
    # The bytes as uploaded; in lists only their digest and name.
    file: StoredRecordingFile
    # Samples per second, measured by the time column from the first to the last, or as stated.
    rate_hz: float | None
    # Samples of the file over the rate, gaps included.
    duration_s: float | None
    # Every column of the file, in its order, as it was recognised or stated; absent in lists.
    columns: NotRequired[list[StoredRecordingColumn] | None]
    # The newest job whose request names the recording; null where none does.
    latest_job: str | None
    created_at: str
    updated_at: str


class StoredRecordingColumn(TypedDict):
    name: str
    # null for a column that is not read.
    quantity: str | None
    axis: str | None
    # null where nobody states it.
    unit: str | None


class StoredRecordingFile(TypedDict):
    """The bytes as uploaded; in lists only their digest and name."""

    sha256: str
    # What the sender called the file; null where nobody said.
    name: str | None
    bytes: NotRequired[int]
    # Name of the format that the file was read as.
    format: NotRequired[str]
    compression: NotRequired[Literal['none', 'gzip', 'xz', 'zstd']]
    rows: NotRequired[int]
    # Names in file order.
    columns: NotRequired[list[str]]
    notes: NotRequired[list[str]]


class StoredRecordingQuality(TypedDict):
    """What was found true of the recording as it came."""

    # Rows of the file, less those that repeat the row before.
    samples: int
    # Samples of the window that analysis uses.
    analysed: int
    # Samples that the time column says are missing between these.
    missing: NotRequired[int]
    gaps: int
    repeated_stamps: int
    # Rows with the stamp and all values of the row before; they do not count as samples. Absent: none.
    repeated_rows: NotRequired[int]
    longest_gap_s: float | None
    # The longest gaps of the analysed part in order of their rows. Absent: none.
    longest_gaps: NotRequired[list[StoredRecordingQualityLongestGap]]
    # Steps of the time column below 0; the recording is split there.
    backward_steps: NotRequired[int]
    # Times a counter in the time column started again; it is continued.
    counter_wraps: NotRequired[int]
    # Stamps given on arrival; samples are read as evenly spaced.
    bursts: NotRequired[bool]
    # Half the distance of the 5 % and 95 % quantiles of the steps of the time column.
    jitter_s: NotRequired[float]
    # From the time column; null without one.
    measured_rate_hz: float | None
    # Measured over stated rate, where both are there.
    clock_ratio: NotRequired[float | None]
    # How warm the analysed part was by the recording's own temperature column. Absent: it has none, or none whose unit
    # is stated.
    temperature: NotRequired[StoredRecordingQualityTemperature]
    # What is true of each sensor column over the whole file, and which of its samples are analysed.
    channels: NotRequired[list[StoredRecordingQualityChannel]]
    notes: list[str]


class StoredRecordingQualityChannel(TypedDict):
    column: str
    # Cells without a number.
    missing: int
    # Numbers that are no measurements (-9999, -1.7e38), taken as missing.
    implausible: int
    # Samples equal to the one before.
    repeated: int
    # Distinct values; null above 256.
    distinct: int | None
    # Step of the lattice on which the values lie, in the unit of the column.
    resolution: float | None
    # Samples at full scale.
    saturated: int
    # The full-scale values where samples pile up, at the lower and the upper end, in the unit of the column; null where
    # none does. Absent: no sample is at full scale.
    rails: NotRequired[list[float | None]]
    # Where the numbers are that mean a missing sample (-9999) or are garbage, in order of their rows. Absent: there is
    # none.
    implausible_at: NotRequired[list[StoredRecordingQualityChannelImplausibleAtItem]]
    # Samples of a stretch in which the sensor gives one value only.
    frozen: int
    # Its first sample, from 1.
    frozen_from: int | None
    # First analysed sample, from 1.
    first: int
    # Last analysed sample.
    last: NotRequired[int]
    # Samples analysed: those of first to last without any of the above.
    analysed: int


class StoredRecordingQualityChannelImplausibleAtItem(TypedDict):
    # The first of the stretch, from 1.
    row: int
    # How many.
    samples: int


class StoredRecordingQualityLongestGap(TypedDict):
    # The sample before which others are missing, from 1.
    row: int
    # How many.
    missing: int


class StoredRecordingQualityTemperature(TypedDict):
    """How warm the analysed part was by the recording's own temperature column. Absent: it has none, or none whose unit
    is stated."""

    column: str
    median_degc: float | None
    # 5 % quantile.
    low_degc: float | None
    # 95 % quantile.
    high_degc: float | None


class StoredStudy(TypedDict):
    """Stored study. A study over uploaded recordings."""

    id: str
    device: str
    study: StudyRequest
    created_at: str


class Study(TypedDict):
    """Study. One device, some of its recordings, and the dynamic condition under which each was made."""

    device: RecordingDevice
    labels: NotRequired[dict[str, str]]
    recordings: list[Recording]
    baseline: NotRequired[StudyBaseline]


class StudyBaselineAuto(TypedDict):
    kind: Literal['auto']


class StudyBaselineFitModel(TypedDict):
    kind: Literal['fit', 'model']
    # A stored fit or model.
    id: str
    channels: NotRequired[list[str]]


class StudyBaselineModel(TypedDict):
    kind: Literal['model']
    processes: ModelProcesses
    # Columns it is for, or columns with processes of their own.
    channels: NotRequired[list[str] | ModelChannels]
    deterministic: NotRequired[ModelDeterministic]
    effects: NotRequired[ModelEffects]
    unnamed: NotRequired[ModelUnnamed]


class StudyRequest(TypedDict):
    """Study over uploaded recordings. The study document with uploaded recordings in place of files. What it says about
    a recording must be what is stored; leave it out to take that."""

    device: StudyRequestDevice
    labels: NotRequired[dict[str, str]]
    recordings: list[StudyRequestRecording]
    baseline: NotRequired[StudyBaseline]


class StudyRequestDevice(TypedDict):
    # Name or id of a device that is known.
    id: str
    model: NotRequired[str]
    imu: NotRequired[str]
    serial: NotRequired[str]


class StudyRequestRecording(TypedDict):
    recording: str
    # The name of the recording in the study.
    id: NotRequired[str]
    rate_hz: NotRequired[float]
    columns: NotRequired[dict[str, Any]]
    stream: NotRequired[str]
    condition: NotRequired[Condition]
    trim: NotRequired[dict[str, Any]]
    calibration: NotRequired[str]


class Token(TypedDict):
    # Public; what logs and the audit log name.
    id: str
    name: str
    scope: Scope
    # null: every device.
    devices: list[str] | None
    created_at: str
    expires_at: str | None
    revoked_at: str | None
    rotated_at: str | None
    # To the minute.
    last_used_at: str | None


class Trace(TypedDict):
    """Trace. A column of a recording as a screen can show it: least, greatest and mean value of every stretch of
    samples."""

    # 1: the samples themselves.
    samples_per_bucket: int
    # Of the first sample of each stretch since the first of the file; evenly spaced but for gaps; in a long recording
    # the first stretch may be shorter. Of a stretch that stands for a gap, where the gap begins.
    time_s: list[float]
    # null where a stretch has no sample, as in each of the longest gaps of the time column.
    min: list[float | None]
    max: list[float | None]
    mean: list[float | None]
    # From when to when [s] stretches lack samples.
    missing: list[list[float]]
    # What must not be taken for the sensor's noise. Of the whole file: trimmed ends, its longest gaps, numbers that are
    # no measurements (such as -9999), and where the sensor gives one value only; of the stretches of this trace: those
    # that reach full scale.
    flags: list[TraceFlag]
    # null where nobody states it.
    unit: str | None
    # Of the whole file.
    duration_s: float | None
    # Of the samples between gaps.
    rate_hz: float | None


class TraceFlag(TypedDict):
    kind: Literal['trim', 'gap', 'flagged', 'frozen', 'saturated']
    # Of a gap the sample before it.
    t0: float
    # Of a gap the sample after it.
    t1: float
    # Of a gap: how many samples.
    missing: NotRequired[int]


class Trends(TypedDict):
    """Trends. How each parameter of one sensor axis moves with |rate| and |angular acceleration|."""

    device: str
    sensor: Literal['gyroscope', 'accelerometer', 'sensor']
    axis: str | None
    method: Literal['av', 'gmwm']
    model: str | None
    pooling: NotRequired[ParameterTablePooling]
    trends: list[TrendsTrend]


class TrendsRelation(TypedDict):
    """low + (high - low) (w/scale)^exponent, w the magnitude."""

    kind: Literal['constant', 'linear', 'power']
    formula: str
    low: float
    high: float
    exponent: float
    scale: float
    # Standard deviation of the logarithm about the relation that the intervals do not explain.
    spread: float
    aicc: float


class TrendsTrend(TypedDict):
    parameter: str
    unit: str | None
    against: TrendsTrendAgainst
    points: list[TrendsTrendPoint]
    # Conditions that do not identify the parameter.
    left_out: list[TrendsTrendLeftOutItem]
    # Cochran's Q: that all conditions share one value.
    equal: TrendsTrendEqual
    # Weighted regression on the rank of the magnitude; up or down at 5 %.
    monotone: TrendsTrendMonotone
    relation: TrendsRelation
    candidates: NotRequired[list[TrendsRelation]]
    statement: str


class TrendsTrendAgainst(TypedDict):
    kind: Literal['rate', 'angular_acceleration']
    unit: Literal['deg/s', 'deg/s^2']


class TrendsTrendEqual(TypedDict):
    """Cochran's Q: that all conditions share one value."""

    statistic: float
    dof: int
    p: float


class TrendsTrendLeftOutItem(TypedDict):
    label: str
    at: float
    reason: str


class TrendsTrendMonotone(TypedDict):
    """Weighted regression on the rank of the magnitude; up or down at 5 %."""

    statistic: float | None
    p: float | None
    direction: Literal['up', 'down', 'none']
    # Two or three conditions: no spread between them can be told.
    few: bool


class TrendsTrendPoint(TypedDict):
    label: str
    at: float
    value: float
    ci95: list[float | None]
    contamination: NotRequired[Literal['clean', 'undecided', 'contaminated', None]]
    robust: NotRequired[bool]


class Upload(TypedDict):
    id: str
    length: int
    offset: int
    file_name: str | None
    expires_at: str


class VerifyAuditAnswer(TypedDict):
    rows: int
    head: str
    sound: bool
    # The first row that is not as it was written.
    fault: str | None


class Webhook(TypedDict):
    id: str
    url: str
    description: str
    events: WebhookEvents
    enabled: bool
    disabled_at: str | None
    # A sentence.
    disabled_why: str | None
    # Deliveries given up since the last that arrived.
    given_up: int
    previous_secret_until: str | None
    revision: int
    created_at: str
    updated_at: str


class WebhookChange(TypedDict):
    url: NotRequired[str]
    description: NotRequired[str]
    events: NotRequired[WebhookEvents]
    enabled: NotRequired[bool]


class WebhookDelivery(TypedDict):
    # The webhook-id that the receiver sees.
    id: str
    webhook: str
    type: Literal['job.ended', 'regression.ended', 'investigation.ended', 'webhook.test']
    job: str | None
    state: Literal['waiting', 'delivered', 'given_up']
    attempts: int
    next_attempt_at: str | None
    # What the receiver answered last.
    last_status: int | None
    # Why the last attempt failed.
    last_error: str | None
    # What is sent.
    message: dict[str, Any]
    created_at: str
    ended_at: str | None


CalibrationEstimates: TypeAlias = "dict[str, Quantity]"
Condition: TypeAlias = (
    "ConditionStatic | ConditionProfileDrive | ConditionConstantRate | ConditionConstantAngularAcceleration | "
    "ConditionSixPosition")
ConditionAxis: TypeAlias = "Literal['x', 'y', 'z']"
DriveColumns: TypeAlias = "dict[str, DriveColumn]"
DriveEvaluation: TypeAlias = (
    "DriveEvaluationMeasured | DriveEvaluationSimulation | DriveEvaluationExplanation | DriveEvaluationComparison")
DriveEvaluationMotion: TypeAlias = "Literal['rest', 'straight', 'turning']"
FitModelFitIntervals: TypeAlias = "Literal['profile', 'sandwich', 'bootstrap']"
FitModelFitProcesses: TypeAlias = "list[FitProcess]"
FitModelFitVerdict: TypeAlias = "Literal['accepted', 'described', 'not_described', 'untested', None]"
InvestigationConcern: TypeAlias = "Literal['recording', 'calibration', 'noise', 'format']"
JobRequest: TypeAlias = (
    "JobRequestCharacterise | JobRequestOutageEvaluation | JobRequestDriveEvaluation | JobRequestInvestigate | "
    "JobRequestPool | JobRequestRegress")
JobRequestDriveQuestionModels: TypeAlias = "list[JobRequestDriveQuestionModel]"
JobRequestDriveQuestionQuestion: TypeAlias = "Literal['run', 'simulate', 'explain', 'compare']"
JobState: TypeAlias = "Literal['queued', 'running', 'succeeded', 'failed', 'cancelled', 'dead']"
ModelChannels: TypeAlias = "dict[str, ModelChannel]"
ModelDeterministic: TypeAlias = "dict[str, ModelDeterministicItem]"
ModelEffects: TypeAlias = "list[ModelEffect]"
ModelNumbers: TypeAlias = "dict[str, ModelNumber]"
ModelProcesses: TypeAlias = "list[ModelProcess]"
ModelUnnamed: TypeAlias = "list[ModelProfile]"
OutageScenarioModel: TypeAlias = "list[OutageScenarioModelItem]"
OutageScenarioSensor: TypeAlias = "OutageScenarioAxis | OutageScenarioSensor2"
ProblemErrors: TypeAlias = "list[ProblemError]"
QuantityIdentified: TypeAlias = "Quantity | None"
RecordingMembersColumns: TypeAlias = "dict[str, RecordingColumn]"
RecordingMembersTrim: TypeAlias = "RecordingTrim"
RegressionVerdict: TypeAlias = "Literal['pass', 'fail', 'inconclusive']"
Scope: TypeAlias = "Literal['read', 'write', 'run', 'admin']"
StudyBaseline: TypeAlias = "StudyBaselineAuto | StudyBaselineModel | StudyBaselineFitModel"
WebhookEvents: TypeAlias = "list[Literal['job.ended', 'regression.ended', 'investigation.ended']]"

# operationId -> what it takes and gives; `media` are the types of a good answer.
OPERATIONS: dict[str, Operation] = {
    'frontPage': Operation(
        'GET', '/', (), (), ('text/html',)),
    'health': Operation(
        'GET', '/healthz', (), (), ('application/json',)),
    'readiness': Operation(
        'GET', '/readyz', (), (), ('application/json',)),
    'metrics': Operation(
        'GET', '/metrics', (), (), ('text/plain',)),
    'contract': Operation(
        'GET', '/openapi.json', (), (), ('application/json',)),
    'listDocumentation': Operation(
        'GET', '/docs', (), (), ('application/json',)),
    'getDocumentation': Operation(
        'GET', '/docs/{page}', (), (), ('text/markdown',)),
    'getProblemType': Operation(
        'GET', '/problems/{slug}', (), (), ('text/markdown',)),
    'getSchema': Operation(
        'GET', '/schemas/{name}', (), (), ('application/schema+json', 'application/json')),
    'getCounts': Operation(
        'GET', '/v1/counts', ('since', 'include'), (), ('application/json',)),
    'getWorkers': Operation(
        'GET', '/v1/workers', (), (), ('application/json',)),
    'listAttention': Operation(
        'GET', '/v1/attention', ('limit', 'cursor', 'sort', 'device', 'since'), (), ('application/json',)),
    'search': Operation(
        'GET', '/v1/search', ('q', 'limit'), (), ('application/json',)),
    'getSample': Operation(
        'GET', '/v1/samples/{preset}', ('condition', 'seed'), (), ('text/csv',)),
    'listDevices': Operation(
        'GET', '/v1/devices', ('include', 'limit', 'cursor', 'sort', 'q'), (), ('application/json',)),
    'createDevice': Operation(
        'POST', '/v1/devices', (), ('Idempotency-Key',), ('application/json',)),
    'getDevice': Operation(
        'GET', '/v1/devices/{id}', (), (), ('application/json',)),
    'changeDevice': Operation(
        'PATCH', '/v1/devices/{id}', (), ('If-Match',), ('application/json',)),
    'deleteDevice': Operation(
        'DELETE', '/v1/devices/{id}', (), ('If-Match',), ()),
    'getDeviceSummary': Operation(
        'GET', '/v1/devices/{id}/summary', (), (), ('application/json',)),
    'listRecordings': Operation(
        'GET', '/v1/recordings',
        ('limit', 'cursor', 'sort', 'device', 'condition', 'labels', 'q', 'since', 'has_result'),
        (), ('application/json',)),
    'uploadRecording': Operation(
        'POST', '/v1/recordings',
        ('device', 'id', 'condition', 'axis', 'value', 'unit', 'direction', 'rate_hz', 'columns', 'stream',
         'trim_start_s', 'trim_end_s', 'calibration', 'labels', 'session', 'recorded_at', 'file_name'),
        ('Idempotency-Key', 'Repr-Digest'), ('application/json',)),
    'previewRecording': Operation(
        'POST', '/v1/recordings/preview',
        ('device', 'condition', 'rate_hz', 'columns'),
        ('Content-Range', 'Idempotency-Key'), ('application/json',)),
    'getRecording': Operation(
        'GET', '/v1/recordings/{id}', (), (), ('application/json',)),
    'changeRecording': Operation(
        'PATCH', '/v1/recordings/{id}', (), ('If-Match',), ('application/json',)),
    'deleteRecording': Operation(
        'DELETE', '/v1/recordings/{id}', (), ('If-Match',), ()),
    'getRecordingContent': Operation(
        'GET', '/v1/recordings/{id}/content', (), ('Range', 'If-Range'), ('application/octet-stream',)),
    'getCharacterisation': Operation(
        'GET', '/v1/recordings/{id}/characterisation', ('channel',), (), ('application/json',)),
    'getTrace': Operation(
        'GET', '/v1/recordings/{id}/trace',
        ('channel', 't0', 't1', 'points'),
        (), ('application/json', 'application/octet-stream')),
    'getSpectrum': Operation(
        'GET', '/v1/recordings/{id}/spectrum', ('channel', 'scale', 'points'), (), ('application/json',)),
    'getHistogram': Operation(
        'GET', '/v1/recordings/{id}/histogram', ('channel', 'bins'), (), ('application/json',)),
    'getSpectrogram': Operation(
        'GET', '/v1/recordings/{id}/spectrogram', ('channel', 'times', 'bands', 'fit'), (), ('application/json',)),
    'createUpload': Operation(
        'POST', '/v1/uploads',
        (),
        ('Tus-Resumable', 'Upload-Length', 'Upload-Metadata', 'Idempotency-Key'), ('application/json',)),
    'getUpload': Operation(
        'GET', '/v1/uploads/{id}', (), (), ('application/json',)),
    'appendToUpload': Operation(
        'PATCH', '/v1/uploads/{id}', (), ('Tus-Resumable', 'Upload-Offset', 'Upload-Checksum'), ()),
    'deleteUpload': Operation(
        'DELETE', '/v1/uploads/{id}', (), ('Tus-Resumable',), ()),
    'recordUpload': Operation(
        'POST', '/v1/uploads/{id}/recording',
        ('device', 'id', 'condition', 'axis', 'value', 'unit', 'direction', 'rate_hz', 'columns', 'stream',
         'trim_start_s', 'trim_end_s', 'calibration', 'labels', 'session', 'recorded_at', 'file_name'),
        ('Idempotency-Key',), ('application/json',)),
    'createLiveRecording': Operation(
        'POST', '/v1/live-recordings', (), ('Idempotency-Key',), ('application/json',)),
    'getLiveRecording': Operation(
        'GET', '/v1/live-recordings/{id}', (), (), ('application/json',)),
    'addLiveSamples': Operation(
        'POST', '/v1/live-recordings/{id}/samples', ('sequence',), ('Live-Token', 'Idempotency-Key'), ()),
    'finishLiveRecording': Operation(
        'POST', '/v1/live-recordings/{id}/finish', (), ('Live-Token', 'Idempotency-Key'), ('application/json',)),
    'streamLiveRecording': Operation(
        'GET', '/v1/live-recordings/{id}/events', ('channel',), (), ('text/event-stream',)),
    'listJobs': Operation(
        'GET', '/v1/jobs', ('limit', 'cursor', 'sort', 'kind', 'state', 'device'), (), ('application/json',)),
    'createJob': Operation(
        'POST', '/v1/jobs', (), ('Idempotency-Key', 'Prefer'), ('application/json',)),
    'getJob': Operation(
        'GET', '/v1/jobs/{id}', (), ('Prefer',), ('application/json',)),
    'getJobResult': Operation(
        'GET', '/v1/jobs/{id}/result', (), (), ('application/json',)),
    'cancelJob': Operation(
        'POST', '/v1/jobs/{id}/cancel', (), ('Idempotency-Key',), ('application/json',)),
    'streamJobEvents': Operation(
        'GET', '/v1/jobs/{id}/events', (), ('Last-Event-ID',), ('text/event-stream',)),
    'streamEvents': Operation(
        'GET', '/v1/events', ('topics',), ('Last-Event-ID',), ('text/event-stream',)),
    'listFits': Operation(
        'GET', '/v1/fits',
        ('limit', 'cursor', 'sort', 'device', 'recording', 'job', 'quantity', 'axis', 'model', 'best'),
        (), ('application/json',)),
    'getFit': Operation(
        'GET', '/v1/fits/{id}', (), (), ('application/json',)),
    'getImpliedCurves': Operation(
        'GET', '/v1/fits/{id}/implied', (), (), ('application/json',)),
    'getParameterTable': Operation(
        'GET', '/v1/parameter-tables',
        ('device', 'sensor', 'axis', 'method', 'model', 'reference'),
        ('Prefer',), ('application/json', 'text/csv', 'text/plain', 'text/markdown', 'text/x-latex')),
    'getStructure': Operation(
        'GET', '/v1/structures', ('of',), (), ('application/json',)),
    'getTrends': Operation(
        'GET', '/v1/trends',
        ('device', 'sensor', 'axis', 'method', 'model'),
        ('Prefer',), ('application/json', 'text/csv', 'text/plain', 'text/markdown')),
    'listExportTargets': Operation(
        'GET', '/v1/exports', (), (), ('application/json',)),
    'getExport': Operation(
        'GET', '/v1/exports/{target}', ('device',), (), ('text/plain', 'application/json')),
    'listDataSheets': Operation(
        'GET', '/v1/data-sheets', ('model',), (), ('application/json',)),
    'getPopulations': Operation(
        'GET', '/v1/populations',
        ('model', 'sensor'),
        (), ('application/json', 'text/csv', 'text/plain', 'text/markdown')),
    'listStudies': Operation(
        'GET', '/v1/studies', ('limit', 'cursor', 'sort', 'device'), (), ('application/json',)),
    'createStudy': Operation(
        'POST', '/v1/studies', (), ('Idempotency-Key',), ('application/json',)),
    'getStudy': Operation(
        'GET', '/v1/studies/{id}', (), (), ('application/json',)),
    'deleteStudy': Operation(
        'DELETE', '/v1/studies/{id}', (), ('If-Match',), ()),
    'listOutageEvaluations': Operation(
        'GET', '/v1/outage-evaluations', ('limit', 'cursor', 'sort', 'state', 'q', 'since'), (), ('application/json',)),
    'createOutageEvaluation': Operation(
        'POST', '/v1/outage-evaluations', (), ('Idempotency-Key', 'Prefer'), ('application/json',)),
    'getOutageEvaluation': Operation(
        'GET', '/v1/outage-evaluations/{id}', (), ('Prefer',), ('application/json',)),
    'listDrives': Operation(
        'GET', '/v1/drives', ('limit', 'cursor', 'sort', 'device'), (), ('application/json',)),
    'createDrive': Operation(
        'POST', '/v1/drives', (), ('Idempotency-Key',), ('application/json',)),
    'getDrive': Operation(
        'GET', '/v1/drives/{id}', (), (), ('application/json',)),
    'deleteDrive': Operation(
        'DELETE', '/v1/drives/{id}', (), ('If-Match',), ()),
    'listDriveEvaluations': Operation(
        'GET', '/v1/drive-evaluations', ('limit', 'cursor', 'sort', 'state'), (), ('application/json',)),
    'createDriveEvaluation': Operation(
        'POST', '/v1/drive-evaluations', (), ('Idempotency-Key', 'Prefer'), ('application/json',)),
    'getDriveEvaluation': Operation(
        'GET', '/v1/drive-evaluations/{id}', (), ('Prefer',), ('application/json',)),
    'listCalibrations': Operation(
        'GET', '/v1/calibrations', ('limit', 'cursor', 'sort', 'device'), (), ('application/json',)),
    'createCalibration': Operation(
        'POST', '/v1/calibrations', (), ('Idempotency-Key',), ('application/json',)),
    'getCalibration': Operation(
        'GET', '/v1/calibrations/{id}', (), (), ('application/json',)),
    'deleteCalibration': Operation(
        'DELETE', '/v1/calibrations/{id}', (), ('If-Match',), ()),
    'listInvestigations': Operation(
        'GET', '/v1/investigations',
        ('limit', 'cursor', 'sort', 'device', 'study', 'job', 'q', 'since'),
        (), ('application/json',)),
    'getInvestigation': Operation(
        'GET', '/v1/investigations/{id}', (), (), ('application/json', 'text/markdown')),
    'deleteInvestigation': Operation(
        'DELETE', '/v1/investigations/{id}', (), ('If-Match',), ()),
    'listRegressions': Operation(
        'GET', '/v1/regressions',
        ('limit', 'cursor', 'sort', 'device', 'label', 'parameter'),
        (), ('application/json',)),
    'getRegression': Operation(
        'GET', '/v1/regressions/{id}', (), (), ('application/json', 'text/plain', 'text/markdown')),
    'getRegressionJunit': Operation(
        'GET', '/v1/regressions/{id}/junit', ('inconclusive',), (), ('text/xml',)),
    'getRegressionFigure': Operation(
        'GET', '/v1/regressions/{id}/figure', (), (), ('image/svg+xml',)),
    'getRegressionBadge': Operation(
        'GET', '/v1/regressions/{id}/badge', (), (), ('image/svg+xml',)),
    'listRegressionAnchors': Operation(
        'GET', '/v1/regression-anchors', ('limit', 'cursor', 'sort', 'device'), (), ('application/json',)),
    'moveRegressionAnchor': Operation(
        'POST', '/v1/regression-anchors', (), ('Idempotency-Key',), ('application/json',)),
    'listModels': Operation(
        'GET', '/v1/models', ('limit', 'cursor', 'sort', 'device', 'parent'), (), ('application/json',)),
    'createModel': Operation(
        'POST', '/v1/models', (), ('Idempotency-Key',), ('application/json',)),
    'getModel': Operation(
        'GET', '/v1/models/{id}', (), (), ('application/json',)),
    'deleteModel': Operation(
        'DELETE', '/v1/models/{id}', (), ('If-Match',), ()),
    'getModelImpliedCurves': Operation(
        'GET', '/v1/models/{id}/implied', ('recording', 'channel'), (), ('application/json',)),
    'getSession': Operation(
        'GET', '/v1/session', (), (), ('application/json',)),
    'openSession': Operation(
        'POST', '/v1/session', (), (), ('application/json',)),
    'closeSession': Operation(
        'DELETE', '/v1/session', (), (), ()),
    'listTokens': Operation(
        'GET', '/v1/tokens', ('limit', 'cursor', 'sort'), (), ('application/json',)),
    'createToken': Operation(
        'POST', '/v1/tokens', (), (), ('application/json',)),
    'getToken': Operation(
        'GET', '/v1/tokens/{id}', (), (), ('application/json',)),
    'rotateToken': Operation(
        'POST', '/v1/tokens/{id}/rotate', (), (), ('application/json',)),
    'revokeToken': Operation(
        'POST', '/v1/tokens/{id}/revoke', (), ('Idempotency-Key',), ('application/json',)),
    'listWebhooks': Operation(
        'GET', '/v1/webhooks', ('limit', 'cursor', 'sort'), (), ('application/json',)),
    'createWebhook': Operation(
        'POST', '/v1/webhooks', (), (), ('application/json',)),
    'getWebhook': Operation(
        'GET', '/v1/webhooks/{id}', (), (), ('application/json',)),
    'changeWebhook': Operation(
        'PATCH', '/v1/webhooks/{id}', (), ('If-Match',), ('application/json',)),
    'deleteWebhook': Operation(
        'DELETE', '/v1/webhooks/{id}', (), ('If-Match',), ()),
    'rotateWebhook': Operation(
        'POST', '/v1/webhooks/{id}/rotate', (), (), ('application/json',)),
    'testWebhook': Operation(
        'POST', '/v1/webhooks/{id}/test', (), ('Idempotency-Key',), ('application/json',)),
    'listDeliveries': Operation(
        'GET', '/v1/webhooks/{id}/deliveries', ('limit', 'cursor', 'sort', 'state'), (), ('application/json',)),
    'listAudit': Operation(
        'GET', '/v1/audit', ('limit', 'cursor', 'sort'), (), ('application/json',)),
    'verifyAudit': Operation(
        'GET', '/v1/audit-verification', (), (), ('application/json',)),
    'listBackups': Operation(
        'GET', '/v1/backups', ('limit', 'cursor', 'sort'), (), ('application/json',)),
    'createBackup': Operation(
        'POST', '/v1/backups', (), ('Idempotency-Key',), ('application/json',)),
}
