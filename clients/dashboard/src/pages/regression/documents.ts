// What the pages read of a regression run.
import type {Nullable, Quantity, Summary} from '../../api/documents';

export interface Needs { sessions_per_arm: number | null; length_s: number | null; sentence: string | null }
export interface ParameterTest { sensor: string; axis: string; condition: string; name: string; ratio: number | null; ci: Nullable; margin: number; gated: boolean; verdict: string }
export interface RegressionRun {
  id: string; state: string; device: string | null; device_name: string | null; parameters?: ParameterTest[]; baseline: string | null; candidate: string | null; verdict: string | null; summary: Summary | null;
  look: number | null; needs: Needs | null; created_at: string;
}
export interface Test { kind: string; tau_s?: number; name?: string; ratio: number | null; ci: Nullable; upper_single?: number | null; margin: number; gated: boolean; verdict: string; p_adjusted?: number | null; baseline?: Quantity; candidate?: Quantity }
export interface Unit { device: string; condition: string; sensor: string; axis: string; structure: {baseline: string | null; candidate: string | null; pooled: string | null; changed: boolean; p?: number | null}; tests: Test[] }
export interface Finding { check: string; verdict: string; sentence: string | null }
interface Arm { label: string | null; sessions: {session: string; recordings: string[]; duration_s: number}[]; rates_hz: number[]; merged: string[] }
export interface Regression {
  device: string; verdict: string; summary: Summary; scope_s: number; settings: Record<string, unknown>;
  arms: {baseline: Arm; candidate: Arm; history: Arm[]; excluded: {recording: string; reason: string}[]};
  look: {number: number; of: number}; units: Unit[]; findings: Finding[]; comparability: {item: string; comparable: boolean; sentence: string | null}[]; needs: Needs | null;
  versus_previous: {label: string; verdict: string; sentence: string} | null; critical: {seed?: number}; algorithm_version: number;
}

export const VERDICT_MARKS: Record<string, string> = {pass: '●', fail: '■', inconclusive: '○'};
