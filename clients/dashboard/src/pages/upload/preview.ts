// What the daemon says of the beginning of a file before all of it is sent; it keeps nothing.
import {ask, type Problem} from '../../api/client';
import type {Nullable} from '../../api/documents';
import type {Pending, Role} from './pending';

export interface PreviewColumn { name: string; quantity: string | null; axis: string | null; unit: string | null; from: 'header' | 'number' | 'stated'; first: Nullable; course: Nullable }
export interface PreviewDocument {
  format: string | null; whole_file: boolean; rows_seen: number; columns: PreviewColumn[]; rate_hz: {value: number; from: 'time_column' | 'stated'} | null;
  time_guess: {column: string; unit: string; rate_hz: number} | null; condition_guess: {text: string; because: string} | null;
  hints: string[]; problems: {code: string; detail: string; fields: Record<string, string>}[]; notes: string[];
}
export interface Look { document: PreviewDocument | null; problem: Problem | null }

const HEAD_BYTES = 1024 * 1024;

// What a person has said of the columns, as the API takes it.
export function columnsOf(roles: Record<string, Role>): string {
  return Object.entries(roles).filter(([, role]) => role.quantity).map(([name, role]) => `${name}=${role.quantity}:${role.axis}:${role.unit}`).join(',');
}

export async function lookAt(each: Pick<Pending, 'file' | 'device' | 'condition' | 'rate' | 'roles'>): Promise<Look> {
  const {file} = each;
  const head = file.slice(0, HEAD_BYTES);
  const stated = {device: each.device, condition: each.condition, rate_hz: each.rate.trim(), columns: columnsOf(each.roles)};
  const query = new URLSearchParams(Object.entries(stated).filter(([, value]) => value !== ''));
  try {
    const answer = await ask(`/v1/recordings/preview?${query.toString()}`, {method: 'POST', body: head, headers: {'Content-Type': 'application/octet-stream', 'Content-Range': `bytes 0-${head.size - 1}/${file.size}`}});
    return {document: await answer.json() as PreviewDocument, problem: null};
  } catch (error) { return {document: null, problem: error as Problem}; }
}

// The roles that the daemon would give, said by name: with them a person may add one without losing the others.
export function rolesOf(document: PreviewDocument): Record<string, Role> {
  return Object.fromEntries(document.columns.filter(column => column.quantity && column.quantity !== 'unspecified').map(column => [column.name, {quantity: column.quantity!, axis: column.axis ?? '', unit: column.unit ?? ''}]));
}
