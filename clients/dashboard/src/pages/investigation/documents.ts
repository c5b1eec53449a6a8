import type {Nullable, Quantity} from '../../api/documents';
import type {Ratios} from '../../figure/Spectrogram';
import {spaced} from '../../format/words';

export interface Band { q025: Nullable; median: Nullable; q975: Nullable }
export interface SeriesDocument {
  recording: string; channel: string; unit: string;
  wavelet: {scale_s: number[]; measured: Nullable; baseline: Band; remaining: Nullable; extended: Band};
  spectrum: {f_hz: number[]; measured: Nullable; highest: Nullable; baseline: Band; chance: Nullable; remaining: Nullable; highest_remaining: Nullable};
  innovations?: {recording: string; scale_s: number; before: number | null; after: number | null; q025: number | null; q975: number | null}[];
  course: {time_s: number[]; error: Nullable; effect: Nullable};
  spectrogram?: Ratios & {recording: string};
}
export interface Finding {
  cause: string; status: 'identified' | 'ambiguous'; alternatives: string[]; rivals?: {cause: string; title: string; score: number | null}[]; channels: string[]; because: string[]; explanation: string; equation?: string; parameters: Record<string, Quantity>; score?: number | null;
  gain: {log_score_per_sample: number | null; misfit_before: number | null; misfit_after: number | null; heldout: boolean; of_the_file?: boolean; explained?: number | null}; next_measurement: string | null;
}
export interface Check { id: string; recording: string | null; channel: string; observed: number | null; p: number | null; p_adjusted: number | null; failed: boolean; failed_after?: boolean; end?: 'finding' | 'mended' | 'unexplained' | null }
export interface Model { processes: {process: string; params: Record<string, Quantity>}[]; effects?: {cause: string; channels: string[]; params: Record<string, Quantity>}[] }
export interface Profile { kind: 'spectrum' | 'variance' | 'mean'; against: string; along: string; channel: string; unit?: string; edges: number[]; middles: number[]; values: Nullable; q025: Nullable; q975: Nullable; gain: {log_score: number | null}; explanation: string }
export interface Investigation {
  study: string; id: string; job: string; device: string; baseline_model?: string; model?: string; created_at: string; baseline: Model; extended_model: Model; checks: Check[]; findings: Finding[];
  summary?: {verdict: string; details: string[]; level: string}; figures?: SeriesDocument[];
  gain: {misfit_before: number | null; misfit_after: number | null; checks_failed_before: number; checks_failed_after: number; explained?: number | null; outage_error_m: {baseline: number | null; extended: number | null; measured: number | null; adopted?: number | null; ci95?: {baseline?: Nullable; extended?: Nullable; adopted?: Nullable}; left_out?: string[]}};
  unexplained: {channel: string; explanation: string; checks: string[]}[]; unnamed?: Profile[]; not_examined?: {cause: string; channel: string; needs: string}[]; notes?: string[];
}
export interface InvestigationRow { id: string; job: string; device: string; study: string; created_at: string; findings: {cause: string; status: string; channels: string[]}[] }

// The name of a finding in the address: the how-manieth of its cause.
export const keyOf = (finding: Finding, findings: readonly Finding[]): string => `${finding.cause}:${findings.filter(each => each.cause === finding.cause).indexOf(finding) + 1}`;
// The frequency of a finding that is a line; null for any other.
export const frequencyOf = (finding: Finding): number | null => Object.values(finding.parameters).find(quantity => quantity.unit === 'Hz')?.value ?? null;

// The checks that a finding rests on; those of a file's recordings are told without its id.
export const restsOn = (finding: Finding, checks: readonly Check[]): Check[] => checks.filter(check => finding.because.some(id => check.id === id || check.id.endsWith(id)));

export const causeName = (cause: string): string => spaced(cause);

// The column of `rec_…/gyro_x (rad/s)`: what follows the id.
export const columnOf = (channel: string): string => channel.replace(/^rec_[0-9A-Z]{26}\//, '');
export const axisOf = (channel: string): string => /(?:^|[^a-z])([xyz])(?:[^a-z]|$)/i.exec(columnOf(channel).replace(/_/g, ' '))?.[1]?.toLowerCase() ?? columnOf(channel);
// The kind of a check: what follows the channel; scales are written as times.
export function checkKind(check: Check): string {
  // A column may be called "2", which a scale of 0.32 s holds too.
  const stem = [`${check.recording}/${check.channel}.`, `${check.channel}.`].find(each => check.id.startsWith(each));
  const tail = check.id.slice(stem?.length ?? check.id.lastIndexOf(check.channel) + check.channel.length + 1);
  const scale = /^wavelet_variance_(.+)s$/.exec(tail);
  return scale ? `${Number(scale[1]).toPrecision(2)} s` : causeName(tail);
}
