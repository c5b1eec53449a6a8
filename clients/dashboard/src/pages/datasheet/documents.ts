// What the pages read of data sheets: facts that a manufacturer states, each with its source.
import {useRead} from '../../api/client';
import type {List} from '../../api/documents';
import {writeTick} from '../../format/number';

export interface Stated { value: number; unit: string }
export interface SensorSheet {
  sensor: 'gyroscope' | 'accelerometer'; unit: string; place: string; full_scales: {limit: number; per_count?: number}[];
  noise_density?: Stated; noise_density_z?: Stated; random_walk?: Stated; bias_stability?: Stated; N?: Stated; bandwidth_hz?: number[]; rate_hz?: number[];
}
export interface DataSheetDocument { name: string; manufacturer: string; document: string; revision?: string; also: string[]; sensors: SensorSheet[] }

// The sheets of the sensors that a text names; none where the text is empty or nothing is known.
export function useSheets(text: string | null | undefined): DataSheetDocument[] {
  const read = useRead<List<DataSheetDocument>>(text ? `/v1/data-sheets?model=${encodeURIComponent(text)}` : null);
  return read.data?.items ?? [];
}

// A stated figure has no interval and no more digits than the document gave it.
export const writeStated = (value: number): string => writeTick(Number(value.toPrecision(3)));

export const sourceOf = (sheet: DataSheetDocument): string => `${sheet.manufacturer} ${sheet.document}${sheet.revision ? `, revision ${sheet.revision}` : ''}`;
