// What waits to be uploaded outlives a reload: in IndexedDB, for each tab on its own, so that two tabs never send the same.
import type {Role} from './pending';

export interface Kept { key: number; device: string; condition: string; rate: string; roles: Record<string, Role>; name?: string | undefined; trim?: [number, number] | undefined }
interface Row extends Kept { id: string; at: number }

const MOST_BYTES = 256 * 1024 * 1024;  // of a larger file only what was said is kept; it is chosen again
const OLD_MS = 3 * 24 * 3600 * 1000;
const TAB = 'driftlab-tab';

function tabName(): string {
  try {
    const known = sessionStorage.getItem(TAB) ?? Math.random().toString(36).slice(2);
    sessionStorage.setItem(TAB, known);
    return known;
  } catch { return ''; }
}
const tab = tabName();
const idOf = (key: number): string => `${tab}:${key}`;

const base = new Promise<IDBDatabase>((resolve, reject) => {
  const request = indexedDB.open('driftlab-upload', 1);
  request.onupgradeneeded = () => { request.result.createObjectStore('rows', {keyPath: 'id'}); request.result.createObjectStore('files'); };
  request.onsuccess = () => resolve(request.result);
  request.onerror = () => reject(request.error);
});
base.catch(() => undefined);  // where the browser keeps nothing, nothing is kept

async function within<T>(work: (rows: IDBObjectStore, files: IDBObjectStore) => IDBRequest<T>): Promise<T> {
  const change = (await base).transaction(['rows', 'files'], 'readwrite');
  const request = work(change.objectStore('rows'), change.objectStore('files'));
  return new Promise((resolve, reject) => { request.onsuccess = () => resolve(request.result); request.onerror = () => reject(request.error); });
}
const quietly = (work: Promise<unknown>): void => { work.catch(() => undefined); };

export const keepFile = (key: number, file: File): void => { if (file.size <= MOST_BYTES) quietly(within((_, files) => files.put(file, idOf(key)))); };
export const keep = ({key, device, condition, rate, roles, name, trim}: Kept): void => quietly(within(rows => rows.put({id: idOf(key), at: Date.now(), key, device, condition, rate, roles, name, trim} satisfies Row)));
const drop = (id: string): void => quietly(within((rows, files) => { files.delete(id); return rows.delete(id); }));
export const forget = (key: number): void => drop(idOf(key));

// What this tab had, each with its file.
export async function kept(): Promise<(Kept & {file: File})[]> {
  const rows = await within<Row[]>(all => all.getAll() as IDBRequest<Row[]>);
  const found: (Kept & {file: File})[] = [];
  for (const {id, at, ...said} of rows) {
    if (id !== idOf(said.key)) { if (Date.now() - at > OLD_MS) drop(id); continue; }
    const file = await within<File | undefined>((_, files) => files.get(id) as IDBRequest<File | undefined>);
    if (file) found.push({...said, file}); else drop(id);
  }
  return found;
}
