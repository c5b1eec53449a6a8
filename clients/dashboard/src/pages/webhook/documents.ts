// What the pages read of webhooks: receivers that are told when jobs end.
import {listWords} from '../../format/words';

export const EVENTS = ['regression.ended', 'investigation.ended', 'job.ended'] as const;
export type EventType = typeof EVENTS[number];

export interface WebhookDocument {
  id: string; url: string; description: string; events: EventType[]; enabled: boolean; disabled_at: string | null; disabled_why: string | null;
  given_up: number; previous_secret_until: string | null; revision: number; created_at: string;
}
export interface Issued extends WebhookDocument { secret: string }
export interface Delivery {
  id: string; type: string; job: string | null; state: 'waiting' | 'delivered' | 'given_up'; attempts: number; next_attempt_at: string | null;
  last_status: number | null; last_error: string | null; message: unknown; created_at: string; ended_at: string | null;
}

export const EVENT_WORDS: Record<EventType, string> = {'regression.ended': 'regressions', 'investigation.ended': 'investigations', 'job.ended': 'all other jobs'};

// A person paused it; nothing is wrong with the receiver.
export const isPaused = (hook: WebhookDocument): boolean => !hook.enabled && (hook.disabled_why === null || /by hand/.test(hook.disabled_why));

export const hears = (hook: {events: readonly EventType[]}): string => hook.events.length === EVENTS.length ? 'every job that ends' : listWords(EVENTS.filter(event => hook.events.includes(event)).map(event => EVENT_WORDS[event]));

// Where the address leads, without what may be a secret of its path.
export function receiverOf(url: string): string {
  try { return new URL(url).host; } catch { return url; }
}
