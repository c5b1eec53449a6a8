// The jobs that characterise recordings of a device now, and the line that says how far they are.
import type {JSX} from 'preact';
import {useRead} from '../api/client';
import type {Job, List} from '../api/documents';
import {plural} from '../format/words';
import {Progress} from './states';

const EVERY_MS = 1000;

// Running ones first. null reads nothing.
export function useLiveJobs(device: string | null): Job[] {
  const of = (state: string): string | null => device && `/v1/jobs?device=${encodeURIComponent(device)}&kind=characterise&state=${state}&limit=50`;
  const running = useRead<List<Job>>(of('running'), EVERY_MS);
  const queued = useRead<List<Job>>(of('queued'), EVERY_MS);
  return [...running.data?.items ?? [], ...queued.data?.items ?? []];
}

export function LiveLine({jobs}: {jobs: readonly Job[]}): JSX.Element | null {
  const [first] = jobs;
  if (!first) return null;
  const more = jobs.length > 1 ? `; ${plural(jobs.length - 1, 'more job')} after it` : '';
  return <div role="status"><p class="verdict">Characterising: {first.state === 'queued' ? 'waiting for a worker' : `${first.stage ?? 'starting'}, ${Math.round(first.progress * 100)} %`}{more}</p><Progress share={first.progress} label="Characterising" /></div>;
}
