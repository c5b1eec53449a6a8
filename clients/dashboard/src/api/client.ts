// The daemon as the page sees it: documents, problems, and whether it answers at all.
import {useEffect, useRef, useState} from 'preact/hooks';
import {listening, onEvents, useEvents, whenBroken} from './events';

export interface ProblemDocument {
  type: string;
  title: string;
  status: number;
  detail: string;
  code?: string;
  request_id?: string;
  retryable?: boolean;
  errors?: {pointer: string; code: string; detail: string}[];
  where?: Record<string, unknown>;
}

export class Problem extends Error {
  constructor(readonly document: ProblemDocument) {
    super(document.detail);
  }
}

const UNREACHABLE: ProblemDocument = {type: '', title: 'No answer', status: 0, detail: 'The daemon does not answer.', retryable: true};

// --- whether the daemon answers
type Listener = (offline: boolean) => void;
let offline = false;
const watchers = new Set<Listener>();
const RETRY_MS = 5000;

function setOffline(now: boolean): void {
  if (now === offline) return;
  offline = now;
  for (const watcher of [...watchers]) watcher(now);
  if (now) void knock();
}

async function knock(): Promise<void> {
  while (offline) {
    await new Promise(resolve => setTimeout(resolve, RETRY_MS));
    try {
      const answer = await fetch('/healthz', {cache: 'no-store'});
      if (answer.ok) setOffline(false);
    } catch { /* it still does not */ }
  }
}

export function useOffline(): boolean {
  const [state, setState] = useState(offline);
  useEffect(() => {
    watchers.add(setState);
    setState(offline);
    return () => { watchers.delete(setState); };
  }, []);
  return state;
}

// --- whether the daemon asks for a token that this browser does not have
let locked = false;
const lockWatchers = new Set<Listener>();

function setLocked(now: boolean): void {
  locked = now;
  for (const watcher of [...lockWatchers]) watcher(now);
}

export function useLocked(): boolean {
  const [state, setState] = useState(locked);
  useEffect(() => {
    lockWatchers.add(setState);
    setState(locked);
    return () => { lockWatchers.delete(setState); };
  }, []);
  return state;
}

async function problemOf(answer: Response): Promise<Problem> {
  const text = await answer.text();
  try {
    const document = JSON.parse(text) as ProblemDocument;
    if (typeof document.detail === 'string') return new Problem(document);
  } catch { /* no problem document */ }
  return new Problem({type: '', title: answer.statusText, status: answer.status, detail: `The daemon answered ${answer.status}.`, retryable: answer.status >= 500});
}

export async function ask(path: string, init: RequestInit = {}): Promise<Response> {
  let answer: Response;
  try {
    answer = await fetch(path, init);
  } catch (error) {
    if ((error as Error).name === 'AbortError') throw error;
    setOffline(true);
    throw new Problem(UNREACHABLE);
  }
  setOffline(false);
  if (answer.status === 401 && !(init.method === 'POST' && path === '/v1/session')) setLocked(true);
  if (!answer.ok) throw await problemOf(answer);
  return answer;
}

export async function get<T>(path: string, signal?: AbortSignal): Promise<T> {
  const answer = await ask(path, {headers: {Accept: 'application/json'}, ...(signal ? {signal} : {})});
  return await answer.json() as T;
}

export async function send<T>(method: string, path: string, body?: unknown, headers: Record<string, string> = {}): Promise<T> {
  const answer = await ask(path, {
    method, headers: {Accept: 'application/json', ...(body === undefined ? {} : {'Content-Type': 'application/json'}), ...headers},
    ...(body === undefined ? {} : {body: JSON.stringify(body)}),
  });
  const text = await answer.text();
  return (text ? JSON.parse(text) : null) as T;
}

// Whatever its revision.
export const remove = (path: string): Promise<null> => send<null>('DELETE', path, undefined, {'If-Match': '*'});

// --- documents as a page reads them
export interface Read<T> {
  data: T | undefined;
  problem: Problem | undefined;
  loading: boolean;
  again: () => void;
}

const kept = new Map<string, unknown>();  // what Back shows at once, until the daemon has said whether it still holds
const MOST_KEPT = 40;

function keep(path: string, data: unknown): void {
  kept.delete(path);
  kept.set(path, data);
  const oldest = kept.keys().next().value;
  if (kept.size > MOST_KEPT && oldest !== undefined) kept.delete(oldest);
}

// Reads a path, again whenever it changes, `again` is called, the daemon is back, or something happened in the lab, but then at most
// every `everyMs`; where no events come, every `everyMs`. null reads nothing.
export function useRead<T>(path: string | null, everyMs?: number): Read<T> {
  const [turn, setTurn] = useState(0);
  const [state, setState] = useState<{path: string | null; data?: T | undefined; problem?: Problem | undefined}>({path: null});
  const isOffline = useOffline();
  const latest = useRef(path);
  latest.current = path;
  useEffect(() => {
    if (path === null || isOffline) return undefined;
    const abort = new AbortController();
    get<T>(path, abort.signal).then(data => {
      keep(path, data);
      setState({path, data});
    }, error => {
      if (!abort.signal.aborted) setState(before => ({path, data: before.path === path ? before.data : undefined, problem: error as Problem}));
    });
    return () => abort.abort();
  }, [path, turn, isOffline]);
  useEffect(() => {
    if (!everyMs || path === null) return undefined;
    let due = false;
    const read = (): void => { due = false; setTurn(n => n + 1); };
    let waiting = 0;
    const stop = onEvents(() => {
      if (waiting) { due = true; return; }
      read();
      waiting = window.setTimeout(() => { waiting = 0; if (due) read(); }, everyMs);
    });
    const timer = setInterval(() => { if (!document.hidden && !listening()) read(); }, everyMs);
    return () => { stop(); clearInterval(timer); clearTimeout(waiting); };
  }, [path, everyMs]);
  const mine = state.path === path;
  const data = mine && state.data !== undefined ? state.data : path === null ? undefined : kept.get(path) as T | undefined;
  return {data, problem: mine ? state.problem : undefined, loading: path !== null && data === undefined && !(mine && state.problem), again: () => setTurn(n => n + 1)};
}

// What moves of one job.
export function useJobEvents(job: string | null, onEvent: () => void): void {
  useEvents(event => { if (job && (event.type === 'ready' || event.type === 'reset' || event.data.job === job)) onEvent(); });
  useEffect(() => { if (job) onEvent(); }, [job]);  // it may have ended while it was read for the first time
}

whenBroken(() => { ask('/healthz', {cache: 'no-store'}).catch(() => undefined); });
