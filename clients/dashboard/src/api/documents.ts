// The parts of the API's documents that pages read. api/contract_check.ts holds them against the types made from openapi.yaml.
import type {Quantity} from '../format/number';
import type {Condition} from '../format/words';

export type {Condition, Quantity};
export type Nullable = (number | null)[];
export type Ends = (number | null)[];

export interface List<T> { items: T[]; next_cursor: string | null }

export interface Session { authentication: 'off' | 'token' | 'session'; token: string | null; name: string | null; scope: string; devices: string[] | null }

export interface Summary { verdict: string; details: string[]; level: string; facts: {pointer: string; value: number | null}[] }

export interface AxisSummary {
  quantity: string; axis: string | null; recording: string; condition: Condition | null; model: string;
  N: Quantity | null; fits: boolean | null; level: string; reason: string | null;
}
export interface DeviceSummary {
  recordings: number;
  conditions: {condition: Condition | null; recordings: number}[];
  channels: AxisSummary[];
  latest: {kind: string; id: string; href: string; job: string; recording: string | null; at: string; level: string | null; verdict: string | null} | null;
}
export interface Device { id: string; name: string; model?: string; imu?: string; serial?: string; labels?: Record<string, string>; created_at: string; summary?: DeviceSummary | null }

export interface ChannelQuality { column: string; missing: number; implausible: number; repeated: number; saturated: number; frozen: number; analysed?: number; resolution: number | null }
export interface Quality {
  samples: number; analysed: number; missing?: number; gaps: number; repeated_stamps: number; backward_steps?: number; counter_wraps?: number;
  longest_gap_s: number | null; measured_rate_hz: number | null; jitter_s?: number; channels?: ChannelQuality[]; notes: string[];
}
export interface Metadata { id?: string; rate_hz?: number; condition: Condition; columns?: Record<string, {quantity: string; axis?: string; unit?: string}>; calibration?: string; stream?: string; trim?: {start_s?: number; end_s?: number}; labels?: Record<string, string> }
export interface Recording {
  id: string; device: string; revision: number; metadata: Metadata; quality: Quality; created_at: string; rate_hz: number | null; duration_s: number | null; latest_job: string | null;
  file: {sha256: string; name: string | null; bytes?: number; format?: string; compression?: string; rows?: number; columns?: string[]; notes?: string[]};
}

export interface ProcessEstimate { process: string; params: Record<string, Quantity | null>; reasons?: Record<string, string> }
export interface ModelFit {
  model: string; robust: boolean; processes: ProcessEstimate[]; wic: number | null; plausible?: boolean; distance_2p?: number; closest?: boolean; status: string; warnings: string[];
  j_test: {statistic: number | null; dof: number | null; p: number | null} | null; intervals?: string; bounds_active?: string[];
}
export interface Equivalent { convention: string; value: number; unit: string; ci95: Ends }
export interface Channel {
  channel: string; quantity: string; axis: string | null; unit: string; samples: number; missing?: number; dt_s: number; mean: number | null;
  allan: {tau_s: number[]; deviation: Nullable; ci95: Ends[]; edf?: Nullable};
  haar: {scale: number[]; variance: Nullable; ci95: Ends[]; robust?: {variance: Nullable; ci95: (Ends | null)[]}};
  contamination?: {verdict: string; p: number | null; disjoint_scales: number[]; flagged_samples: number; bursts?: number; not_gaussian?: boolean};
  stationarity?: {changes: {kind: 'jump' | 'level'; time_s: number; size: number | null; unit: string}[]};
  allan_parameters: Record<'N' | 'B' | 'K' | 'Q' | 'R', Quantity | null> & {reasons: Record<string, string>};
  fits: ModelFit[];
  equivalents?: {N?: Equivalent[]; K?: Equivalent[]};
  best: number | null; warnings: string[];
}
export interface Implied {
  unit: string;
  allan: {tau_s: number[]; deviation: Nullable; components: {process: string; deviation: Nullable}[]};
  spectrum: {f_hz: number[]; density: Nullable; components: {process: string; density: Nullable}[]};
  ratio: {tau_s: number[]; deviation: Nullable; measured_over_model: Nullable; ci95: Ends[]};
}
export interface CharacterisedChannel { summary: Summary; fit_ids: string[]; implied: Implied | null; result: Channel }
export interface Characterisation {
  recording: string; revision: number; stale: boolean; job: string; created_at: string; algorithm_version: number;
  parameters: {seed?: number; models?: string[]}; condition: Condition; duration_s: number; rate_hz: number; channels: CharacterisedChannel[];
}
export interface Trace { unit: string | null; duration_s: number | null; rate_hz: number | null; samples_per_bucket: number; time_s: number[]; min: Nullable; max: Nullable; mean: Nullable; missing: [number, number][]; flags: TraceFlag[] }
export interface TraceFlag { kind: 'trim' | 'gap' | 'flagged' | 'frozen' | 'saturated'; t0: number; t1: number; missing?: number }

export interface Spectrum { unit: string; dt_s: number; samples: number; first_s: number; f_hz: number[]; density: Nullable; ci95: Ends[]; max: Nullable; segments: number; segment_samples: number; window: string }
export interface Histogram { unit: string; dt_s: number; samples: number; first_s: number; median: number | null; sigma: number | null; reason?: string; edges?: number[]; counts?: number[]; gaussian?: number[]; below?: number; above?: number; apart?: {t0: number; t1: number; samples: number; deviations: number}[] }
export interface Spectrogram { unit: string; dt_s: number; samples: number; first_s: number; expected: 'model' | 'median'; time_s: number[]; f_hz: number[]; log10_ratio: Nullable[]; window_samples: number }

export interface JobArm { label?: string | null; recordings?: Record<string, unknown>[] }
export interface StoredProblem { title?: string; detail: string; type?: string; retryable?: boolean }
export interface Job {
  id: string; kind: string; state: string; stage: string | null; progress: number; attempt: number; cancel_requested: boolean;
  created_at: string; started_at: string | null; finished_at: string | null; device_name: string | null; recording_name: string | null;
  request: {kind: string; inputs: {recordings?: {id: string; revision: number; name?: string}[]; study?: string; device?: string; axis?: string; scenario?: unknown; drive?: string; document?: Record<string, unknown> & {id: string}; baseline?: JobArm; candidate?: JobArm; excluded?: unknown[]}; parameters: {seed?: number; runs?: number; question?: string}; algorithm_version: number};
  result: {href: string} | null; problem: StoredProblem | null; failed_attempts: StoredProblem[];
}
export interface CountSince { at: string; count: number }
export interface Counts { devices: number; recordings: number; attention?: Attention[]; jobs: {queued: number; running: number; succeeded_since?: CountSince; failed_since?: CountSince} }
export interface Attention { id: string; level: string; verdict: string; kind: string; job: string; device_name: string | null; recording: string | null; channel: string | null; created_at: string; href: string }
