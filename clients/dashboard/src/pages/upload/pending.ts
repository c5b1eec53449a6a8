// Files that wait to be uploaded, and what was said about them. They outlive a change of page, so nothing typed is lost.
import {useEffect, useState} from 'preact/hooks';
import type {Problem} from '../../api/client';
import {forget, keep, keepFile, kept} from './kept';
import {lookAt, type Look} from './preview';

export interface Role { quantity: string; axis: string; unit: string }
export type State = 'ready' | 'sending' | 'paused' | 'sent' | 'refused';

export interface Pending {
  key: number;
  file: File;
  device: string;
  condition: string;
  rate: string;
  roles: Record<string, Role>;  // only what a person chose
  name?: string | undefined;               // of the recording, where it is not that of the file
  trim?: [number, number] | undefined;     // seconds at its beginning and end
  look: Look | null;
  lookedAt?: string | undefined;           // what was said of it when the daemon was asked for `look`
  state: State;
  share: number;
  problem: Problem | null;
  recording: string | null;
  job: string | null;
}

let next = Date.now();  // keys of an earlier load of the page are in its address
let list: Pending[] = [];
const listeners = new Set<() => void>();

function tell(): void { for (const listener of [...listeners]) listener(); }

export function usePending(): readonly Pending[] {
  const [, again] = useState(0);
  useEffect(() => {
    const listener = (): void => again(n => n + 1);
    listeners.add(listener);
    return () => { listeners.delete(listener); };
  }, []);
  return list;
}

export const pending = (): readonly Pending[] => list;

const SAID: readonly (keyof Pending)[] = ['device', 'condition', 'rate', 'roles'];
const saidOf = (each: Pending): string => JSON.stringify(SAID.map(member => each[member]));

// What would be refused as it stands: its sentence stands beside the field that mends it. A sentence about what has been changed since
// holds nothing up: what was just answered is sent with the others.
export const isUnclear = (each: Pending): boolean => each.state === 'ready' && (each.look?.document?.problems.length ?? 0) > 0 && each.lookedAt === saidOf(each);
// What an upload sends: what is clear, or all there is, for the daemon to decide.
export function toSend(all: readonly Pending[]): readonly Pending[] {
  const open = all.filter(each => each.state !== 'sent');
  const clear = open.filter(each => !isUnclear(each));
  return clear.length > 0 ? clear : open;
}

// --- the daemon is asked again once what was said of a file has changed, and nobody types any more
const PAUSE_MS = 300;
const waiting = new Map<number, ReturnType<typeof setTimeout>>();

async function look(key: number): Promise<void> {
  const asked = list.find(each => each.key === key);
  if (!asked) return;
  const seen = await lookAt(asked);
  const now = list.find(each => each.key === key);
  if (!now || saidOf(now) !== saidOf(asked)) return;
  const known = asked.look === null && seen.document ? remembered()[signature(seen)] : undefined;
  change(key, {look: seen, lookedAt: saidOf(asked), ...(known ? {roles: known.roles, rate: known.rate} : {})});
}

export function change(key: number, changes: Partial<Pending>): void {
  list = list.map(each => each.key === key ? {...each, ...changes} : each);
  if (SAID.some(member => member in changes)) {
    clearTimeout(waiting.get(key));
    waiting.set(key, setTimeout(() => { waiting.delete(key); void look(key); }, PAUSE_MS));
    const said = list.find(each => each.key === key);
    if (said) keep(said);
  }
  if (changes.state === 'sent') forget(key);
  tell();
}

export function remove(key: number): void {
  list = list.filter(each => each.key !== key);
  forget(key);
  tell();
}

// --- what was said before, by the set of column names
const KEY = 'driftlab-columns';
type Remembered = Record<string, {roles: Record<string, Role>; rate: string}>;

function remembered(): Remembered {
  try { return JSON.parse(localStorage.getItem(KEY) ?? '{}') as Remembered; } catch { return {}; }
}

const signature = (seen: Look): string => (seen.document?.columns ?? []).map(column => column.name).join('\u0001');

export function remember(each: Pending): void {
  if (!each.look?.document || each.look.document.columns.length === 0 || (Object.keys(each.roles).length === 0 && !each.rate)) return;
  try { localStorage.setItem(KEY, JSON.stringify({...remembered(), [signature(each.look)]: {roles: each.roles, rate: each.rate}})); } catch { /* then it is asked again */ }
}

// The condition that a name suggests; a person sees it and may change it.
function conditionIn(name: string): string {
  const rate = /(\d+(?:\.\d+)?)\s*deg[-_ /]*s(?![a-z0-9])/i.exec(name);
  return rate ? `constant_rate:z:${rate[1]}:deg/s` : 'static';
}

const deviceIn = (name: string): string => name.replace(/\.(csv|txt|npy|npz|mat|json|zip|gz|xz|zst|log|h5|hdf5|bag|ulg|mcap|db3|cwa)\b/gi, '').replace(/[^\w.-]+/g, '-').slice(0, 60) || 'device';

const sameFile = (one: File, other: File): boolean => one.name === other.name && one.size === other.size && one.lastModified === other.lastModified;

// `said`: what is known of them already; else their names and the file before suggest it.
export function addFiles(files: readonly File[], said: Partial<Pick<Pending, 'device' | 'condition' | 'rate' | 'roles' | 'name' | 'trim'>> = {}): void {
  const device = list[list.length - 1]?.device;
  for (const file of files) {
    const again = list.find(one => one.state !== 'sent' && sameFile(one.file, file));
    if (again) {  // chosen once more: what was said of it holds
      change(again.key, {file, ...said});
      keepFile(again.key, file);
      continue;
    }
    const each: Pending = {key: next++, file, device: device ?? deviceIn(file.name), condition: conditionIn(file.name), rate: '', roles: {}, ...said, look: null, state: 'ready', share: 0, problem: null, recording: null, job: null};
    list = [...list, each];
    keep(each);
    keepFile(each.key, file);
    void look(each.key);
  }
  tell();
}

// What this tab had before it was loaded again. A file that was chosen once more meanwhile is not doubled: what was said of it
// holds, unless something has been said since.
kept().then(rows => {
  const others = rows.filter(({key, file, ...said}) => {
    const each = list.find(one => sameFile(one.file, file));
    if (each && !each.rate) change(each.key, said);
    if (each) forget(key);
    return !each;
  });
  list = [...others.map((row): Pending => ({...row, look: null, state: 'ready', share: 0, problem: null, recording: null, job: null})), ...list];
  for (const {key} of others) void look(key);
  tell();
}, () => undefined);
