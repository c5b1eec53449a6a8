// The one stream of a tab: what happens in the lab reaches every part of the page that shows it.
import {useEffect, useRef} from 'preact/hooks';

export interface LabEvent { type: string; data: {job?: string; kind?: string; state?: string; recording?: string; device?: string; href?: string; verdict?: string | null} }
type Listener = (event: LabEvent) => void;

// `ready` comes with every connection: what happened before it was not heard.
const TYPES = ['ready', 'job', 'recording.created', 'recording.changed', 'recording.deleted', 'device.created', 'device.changed', 'device.deleted', 'result.created', 'reset'];
const listeners = new Set<Listener>();
let stream: EventSource | null = null;
let open = false;
let broken: () => void = () => undefined;

// Called when the stream breaks off, which is how an idle page learns that the daemon is gone.
export const whenBroken = (then: () => void): void => { broken = then; };

function start(): void {
  if (stream) return;
  stream = new EventSource('/v1/events');
  stream.onopen = () => { open = true; };
  stream.onerror = () => {
    open = false;
    broken();
    // The browser connects again by itself unless it was refused; then reading at intervals is what remains.
    if (stream?.readyState === EventSource.CLOSED) stream = null;
  };
  for (const type of TYPES) {
    stream.addEventListener(type, message => {
      const event = {type, data: JSON.parse((message as MessageEvent<string>).data) as LabEvent['data']};
      for (const listener of [...listeners]) listener(event);
    });
  }
}

// Whether events come; where they do not, pages read again at intervals.
export const listening = (): boolean => open;

export function onEvents(listener: Listener): () => void {
  start();
  listeners.add(listener);
  return () => { listeners.delete(listener); };
}

export function useEvents(listener: Listener): void {
  const latest = useRef(listener);
  latest.current = listener;
  useEffect(() => onEvents(event => latest.current(event)), []);
}
