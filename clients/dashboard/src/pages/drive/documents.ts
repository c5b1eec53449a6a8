// What the pages read of recorded drives and of what is asked of them.
import type {Ends, Nullable} from '../../api/documents';

export interface Source { recording?: string; columns: Record<string, {quantity: string; axis?: string; unit?: string}>; time: {column?: string; unit?: string; scale: string; rate_hz?: number; offset_s?: number} }
export interface DriveText {
  id: string; vehicle: string; imu: Source & {clock?: string; mounting_deg?: number[] | 'unknown'; accelerometer?: Source};
  gnss: Source & {lever_arm_m?: number[]; fix_types?: number[]}; reference?: string | (Source & {sd_m?: number}); odometer?: Source;
  model: Record<'gyroscope' | 'accelerometer', unknown>; outages?: {duration_s?: number[]; every_s?: number[]; phases?: number; settle_s?: number; at?: number[]};
}
export interface StoredDrive { id: string; device: string; name: string; vehicle: string; drive: DriveText; created_at: string }

export type Question = 'run' | 'simulate' | 'explain' | 'compare';
export interface EvaluationRow { id: string; drive: string; name: string; question: Question; seed: number; state: string; stage: string | null; progress: number; created_at: string; finished_at: string | null; problem: {detail: string} | null }

export interface Estimated { value: number | null; ci95: Ends }
export interface Facts {
  duration_s: number; length_m: number; highest_speed_m_s: number; runs: number; reference: string; notes: string[];
  imu: {rows: number; incomplete_rows: number; repeated_rows: number; stuck_rows: number; polled_faster_than_sampled: boolean; stamped_rate_hz: number; sensor_rate_hz: number; jitter_s: number; gaps_bridged: number; samples_bridged: number; gaps_splitting: number; longest_gap_s: number};
  gnss: {fixes: number; rate_hz: number; held: number; other_types: number; incomplete: number; far_away: number; accuracy_constant: boolean; speed_accuracy_constant: boolean};
}
export interface Growth { time_s: number[]; rms_m: Nullable; p05_m: Nullable; median_m: Nullable; p95_m: Nullable }
export interface OutageOf { start_s: number; phase: number; motion: string; north_m: number; east_m: number; along_m: number; across_m: number; nees: number | null; straight_line_error_m: number; map_m: number[]; covariance_m2: number[] }
export interface Duration {
  duration_s: number; n: number; rms_m: Estimated; median_m: Estimated; p95_m: number; worst_m: number; along_rms_m: number; across_rms_m: number;
  nees: Estimated; coverage50: Estimated; coverage95: Estimated; straight_line_rms_m: number; promised_rms_m: number; growth?: Growth; outages: OutageOf[];
}
export interface Simulated { duration_s: number; n: number; rms_m: number; nees: number | null; coverage95: number; measured_over_simulated: Estimated; growth?: Growth }
export interface Finding { cause: string; words?: string; parameter: string; title: string; value: number | null; se: number | null; unit: string; score: number | null; evidence: string; told_apart: string; at_bound?: boolean; kept: boolean; held_out_gain: number | null; pair?: string; pair_words?: string }
export interface Rung { name: string; kept: boolean; durations: {duration_s: number; held_out: {n: number; rms_m: number; nees: number | null; coverage95: number; log_score: number | null}}[] }
interface Common { id: string; vehicle: string; summary: string; algorithm_version: number; facts: Facts; path?: {north_m: number[]; east_m: number[]}; notes: string[] }
export interface Measured extends Common { options: {velocity_constraint: boolean; zero_velocity: boolean; odometer: boolean}; durations: Duration[]; natural_outages: {start_s: number; duration_s: number}[]; rejected_fixes: number; heading_known_s: number | null; simulated?: Simulated[] }
export interface Side { durations: Duration[]; simulated: Simulated[] }
export interface Explanation extends Common { findings: Finding[]; rungs: Rung[]; white_noise_factors: {gyroscope: number; accelerometer: number}; before: Side; after: Side }
export interface Evaluation extends EvaluationRow { evaluation: Measured | Explanation | Comparison | null }

export interface Comparison extends Common { verdicts: string[]; filters: {name: string; about: string; durations: Duration[]}[] }

// What a page asks; several models are compared from the command line and the API.
export const QUESTIONS: Record<Exclude<Question, 'compare'>, string> = {run: 'Measure outages', simulate: 'Simulate the same beside them', explain: 'Explain the difference'};
export const SHORT: Record<Question, string> = {run: 'measured', simulate: 'measured and simulated', explain: 'explained', compare: 'models compared'};

export const isComparison = (evaluation: Measured | Explanation | Comparison): evaluation is Comparison => 'verdicts' in evaluation;
export const isExplanation = (evaluation: Measured | Explanation): evaluation is Explanation => 'rungs' in evaluation;

// The name of a quantity as people write it.
export const inWords = (text: string): string => text.replace(/\b[a-z]+(?:_[a-z0-9]+)+\b/g, name => name.replace(/_(s|m|deg)$/, '').replace(/_/g, ' ').replace(/\b(gnss|imu)\b/g, word => word.toUpperCase()));

// The first sentence, and what follows it.
export function opened(text: string): [string, string] {
  const end = /[.:](?= [A-Z])/.exec(text);
  return end ? [text.slice(0, end.index + 1), text.slice(end.index + 2)] : [text, ''];
}

export const errorOf = (outage: OutageOf): number => Math.hypot(outage.north_m, outage.east_m);
