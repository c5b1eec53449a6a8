// Queues the work on recordings and leads to it.
import type {JSX} from 'preact';
import {useState} from 'preact/hooks';
import {Problem, send} from '../api/client';
import type {Job} from '../api/documents';
import {Refusal} from './states';

export const characterise = (recordings: string[]): Promise<Job> => send<Job>('POST', '/v1/jobs', {kind: 'characterise', inputs: {recordings}});

export function Characterise({recordings, label, onQueued}: {recordings: string[]; label: string; onQueued: (job: Job) => void}): JSX.Element {
  const [busy, setBusy] = useState(false);
  const [problem, setProblem] = useState<Problem>();
  return <>
    <button type="button" class="btn primary" disabled={busy} onClick={() => {
      setBusy(true);
      setProblem(undefined);
      characterise(recordings).then(onQueued, error => setProblem(error as Problem)).finally(() => setBusy(false));
    }}>{label}</button>
    {problem && <Refusal problem={problem} />}
  </>;
}
