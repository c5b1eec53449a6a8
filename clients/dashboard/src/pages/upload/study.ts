// A study.json that was dropped with its files: what it says of each, and the study that follows once all of them are stored.
import {Problem, send} from '../../api/client';
import type {Condition, Job} from '../../api/documents';
import {conditionText} from '../../format/words';
import type {Pending, Role} from './pending';

interface Stated { id?: string; file?: string; rate_hz?: number; columns?: Record<string, {quantity: string; axis?: string; unit?: string}>; condition: Condition; trim?: {start_s?: number; end_s?: number} }
export interface Study { device: {id: string}; labels?: unknown; baseline?: unknown; recordings: Stated[] }

const refusal = (detail: string): Problem => new Problem({type: '', title: 'Not a study', status: 0, detail});
const last = (path: string): string => path.slice(path.lastIndexOf('/') + 1);

export async function readStudy(file: File): Promise<Study> {
  let study: Partial<Study>;
  try { study = JSON.parse(await file.text()) as Partial<Study>; } catch { throw refusal(`${file.name} is not JSON.`); }
  if (!study.device?.id || !Array.isArray(study.recordings) || study.recordings.length === 0) throw refusal(`${file.name} names no device or no recordings; a study has both.`);
  return study as Study;
}

// What the study says of one of its files.
export type Said = Partial<Pick<Pending, 'device' | 'condition' | 'rate' | 'roles' | 'name' | 'trim'>>;

export function matched(study: Study, files: readonly File[]): [File, Said][] {
  return study.recordings.map(one => {
    const file = files.find(each => last(each.name) === last(one.file ?? ''));
    if (!file) throw refusal(`The study names ${one.file ?? 'a recording without a file'}, which was not dropped with it. Drop them together.`);
    const roles = Object.fromEntries(Object.entries(one.columns ?? {}).map(([name, role]): [string, Role] => [name, {quantity: role.quantity, axis: role.axis ?? '', unit: role.unit ?? ''}]));
    return [file, {device: study.device.id, condition: conditionText(one.condition), rate: one.rate_hz === undefined ? '' : String(one.rate_hz), roles, name: one.id, trim: [one.trim?.start_s ?? 0, one.trim?.end_s ?? 0]}];
  });
}

// The job that investigates it.
export async function investigated(study: Study, recordings: readonly string[]): Promise<Job> {
  const {device, labels, baseline} = study;
  const made = await send<{id: string}>('POST', '/v1/studies', {device, ...(labels ? {labels} : {}), ...(baseline ? {baseline} : {}), recordings: recordings.map(recording => ({recording}))});
  return send<Job>('POST', '/v1/jobs', {kind: 'investigate', inputs: {study: made.id}});
}
