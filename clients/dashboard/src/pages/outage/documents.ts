import type {Ends, Nullable, Quantity, StoredProblem, Summary} from '../../api/documents';

export interface Ellipse { fraction: number; semi_major_m: number; semi_minor_m: number; major_axis_azimuth_deg: number }
export interface Moments { ellipses: Ellipse[] }
export interface Outage {
  index: number; start_s: number; end_s: number; error_m: Quantity; nees: number; nees_ci95: Ends; coverage95: number; predicted: Moments; actual: Moments; errors: {north_m: Nullable; east_m: Nullable}; track?: Track;
}
export interface Path { time_s: number[]; north_m: number[]; east_m: number[] }
export interface Track { start_s: number | null; rate_hz: number; north_m: number[]; east_m: number[] }
export interface Filter { name: string; about: string; states: number; mean_error_m: Quantity; outages: Outage[]; nees: number; nees_ci95: Ends; coverage95: number; trajectory: Path }
export interface Pair { filter: string; against: string; difference_m: Quantity; relative: Quantity }
export interface Evaluation {
  summary?: Summary; runs: number; seed: number; stopped_early: boolean; algorithm_version: number; filters: Filter[];
  attribution: {total: Pair; low_frequency_noise: Pair; gauss_markov_states: Pair; switching: Pair} | null;
  claims: {claim: string; supported: boolean; because: string}[]; trajectory: Path; tracks?: Track[];
}
// What is known while runs go on.
export interface Partial { runs: number; filters: {name: string; error_m: Quantity}[] }
export interface StoredEvaluation { partial?: Partial | null; id: string; scenario_name: string; runs: number; seed: number; state: string; stage: string | null; progress: number; created_at: string; finished_at: string | null; problem: StoredProblem | null; evaluation: Evaluation | null }

export const at95 = (ellipses: readonly Ellipse[]): Ellipse | undefined => ellipses.find(each => Math.abs(each.fraction - 0.95) < 0.01);
