import type {Condition, Ends, Quantity, Summary} from '../../api/documents';
import {capital, processName, spaced, symbolOf} from '../../format/words';

export interface Cell extends Quantity { value: number; unit: string; ci95: Ends; change: 'up' | 'down' | 'none' | null; ratio: Quantity | null }
export interface TableRow {
  condition: Condition; label: string; contamination?: string | null; warnings?: string[]; recordings: string[]; pooling?: string; robust?: boolean;
  agreement?: {p: number | null} | null; density?: Cell | null; values: Record<string, Cell | null>; reasons: Record<string, string>;
  why: Record<string, 'not_identifiable' | 'none_found'>; duration_s: number; fits: boolean | null; j_test_p: number | null;
}
export interface SheetComparison {
  sensor: string; source: string; condition: string;
  figures: {parameter: 'N' | 'B'; stated: number; unit: string; measured: Quantity | null; ratio: number | null; ci95: Ends | null; verdict: 'agrees' | 'above' | 'below' | null}[];
}
export interface StructureDocument { verdict: 'one_structure' | 'changes' | 'undecided'; statement: string; common: string; p: number | null; dof?: number | null; ranking: {model: string; criterion: number | null}[]; by_condition: {label: string; model: string}[] }
export interface ParameterTable {
  device: string; sensor: string; axis: string | null; method: string; model: string | null; reference: string | null; model_note: string | null; columns: {key: string; unit: string | null}[]; rows: TableRow[];
  pooling: {state: string; job: string | null; reason: string | null}; structure?: StructureDocument; summary?: Summary; data_sheet?: SheetComparison;
}
export interface Trend {
  parameter: string; unit: string | null; against: {kind: string; unit: string};
  points: {label: string; at: number; value: number; ci95: Ends}[]; left_out: {label: string; at: number; reason: string}[];
  equal: {p: number}; monotone: {p: number | null; direction: string; few: boolean}; statement: string;
}
export interface Trends { trends: Trend[] }

// Conditions are ordered, so is their colour: rest in ink, rates a blue ramp, accelerations an ochre one.
export function colours(rows: readonly {condition: Condition}[]): string[] {
  const rates = rows.filter(row => row.condition.kind === 'constant_rate').map(row => Math.abs(row.condition.value ?? 0)).sort((a, b) => a - b);
  const accelerations = rows.filter(row => row.condition.kind === 'constant_angular_acceleration').map(row => Math.abs(row.condition.value ?? 0)).sort((a, b) => a - b);
  const ramp = (index: number, count: number, steps: number): number => count <= 1 ? 1 : 1 + Math.round(index / (count - 1) * (steps - 1));
  return rows.map(row => {
    const size = Math.abs(row.condition.value ?? 0);
    if (row.condition.kind === 'constant_rate') return `var(--r${ramp(rates.indexOf(size), rates.length, 4)})`;
    if (row.condition.kind === 'constant_angular_acceleration') return `var(--a${ramp(accelerations.indexOf(size), accelerations.length, 2)})`;
    return 'var(--r0)';
  });
}

const DENSITY = 'low_frequency.N';

// The table of a model begins with N, the density at low frequencies whatever the model; that of the Allan variance has N among its columns.
export function withDensity(table: ParameterTable): ParameterTable {
  const unit = table.rows.find(row => row.density)?.density?.unit;
  if (table.method !== 'gmwm' || !unit) return table;
  const rows = table.rows.map(row => ({...row, values: {[DENSITY]: row.density ?? null, ...row.values}, reasons: {[DENSITY]: 'No model describes the curve.', ...row.reasons}}));
  return {...table, columns: [{key: DENSITY, unit}, ...table.columns], rows};
}

// gauss_markov_1.beta -> Gauss-Markov β
export function columnName(key: string): {process: string; symbol: string} {
  const [process = '', parameter] = key.split('.');
  if (!parameter) return {process: '', symbol: key};
  // low_pass_1 is a name, gauss_markov_1 the first of its kind.
  const [, kind = process, number] = (processName(process) === spaced(process) && /^(.+)_(\d)$/.exec(process)) || [];
  return {process: `${capital(processName(kind))}${number && number !== '1' ? ` ${number}` : ''}`, symbol: symbolOf(parameter)};
}

/// The symbol of a column; with its process where another column has the same one.
export function uniqueName(key: string, columns: readonly {key: string}[]): string {
  const {process, symbol} = columnName(key);
  const alone = columns.filter(column => columnName(column.key).symbol === symbol).length < 2;
  return alone || !process ? symbol : `${process} ${symbol}`;
}
