// What the pages read of populations: all devices of a model, parameter by parameter.
import type {Condition, Quantity, Summary} from '../../api/documents';
import {writeNumber, writeQuantity} from '../../format/number';

export interface PlaceOf { device: string; estimate: Quantity; z: number; quantile: number | null; p: number | null; p_holm: number | null; outlying: boolean }
export interface PopulationRow {
  sensor: 'gyroscope' | 'accelerometer'; axis: string | null; condition: Condition; label: string; parameter: 'N' | 'B' | 'K';
  mean: Quantity | null; spread: number | null; prediction: number[] | null; heterogeneity: {q: number; dof: number; p: number} | null; reason: string | null;
  places: PlaceOf[]; left_out: {device: string; reason: string}[];
}
export interface Flag { device: string; sensor: string; axis: string | null; label: string; parameter: string }
export interface PopulationDocument { model: string; summary: Summary; devices: string[]; rows: PopulationRow[]; outlying: Flag[] }

export const PARAMETERS: Record<PopulationRow['parameter'], string> = {N: 'White noise N', B: 'Bias instability B', K: 'Random walk K'};

// A sensor axis under one condition: what a reader looks at in one go.
export interface Group { key: string; sensor: PopulationRow['sensor']; axis: string | null; label: string; condition: Condition; rows: PopulationRow[] }

export function groupsOf(rows: readonly PopulationRow[]): Group[] {
  const groups = new Map<string, Group>();
  for (const row of rows) {
    const key = `${row.sensor}:${row.axis ?? ''}:${row.label}`;
    const group = groups.get(key) ?? {key, sensor: row.sensor, axis: row.axis, label: row.label, condition: row.condition, rows: []};
    group.rows.push(row);
    groups.set(key, group);
  }
  return [...groups.values()];
}

// An interval that spans more than this is no longer even about its value, whose digits it then cannot decide.
const WIDE = 3;

export function writeMean(mean: Quantity): {value: string; interval: string} {
  const [low, high] = mean.ci95 ?? [];
  if (!low || !high || high / low <= WIDE) return writeQuantity(mean);
  return {value: writeNumber(mean.value, 2), interval: `[${writeNumber(low, 2)}, ${writeNumber(high, 2)}]`};
}

// The deviation of the logarithm, as people say it: devices differ by 12 %.
export const differBy = (spread: number): number => Math.expm1(spread);
