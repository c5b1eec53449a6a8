// What a recording is called beside its name, `firmware=1.5.0`: regression runs compare by it. Written here, shown at once, taken back where
// the daemon refuses it; what was typed stays.
import type {JSX} from 'preact';
import {useEffect, useState} from 'preact/hooks';
import {Problem, send} from '../../api/client';
import type {Recording} from '../../api/documents';
import {Refusal} from '../../shell/states';

type Labels = Record<string, string>;

const written = (labels: Labels): string => Object.entries(labels).map(([name, value]) => `${name}=${value}`).join(', ');

function read(text: string): Labels {
  const parts = text.split(',').map(part => part.trim()).filter(Boolean);
  return Object.fromEntries(parts.map(part => { const at = part.indexOf('='); return at < 0 ? [part, ''] : [part.slice(0, at).trim(), part.slice(at + 1).trim()]; }));
}

export function LabelsOf({recording}: {recording: Recording}): JSX.Element {
  const [typed, setTyped] = useState<string | null>(null);
  const [sent, setSent] = useState<Labels | null>(null);
  const [problem, setProblem] = useState<Problem>();
  useEffect(() => setSent(null), [recording]);  // what was read since is the truth
  const labels = sent ?? recording.metadata.labels ?? {};
  const save = (event: Event): void => {
    event.preventDefault();
    const next = read(typed ?? '');
    setSent(next);
    setProblem(undefined);
    send<Recording>('PATCH', `/v1/recordings/${recording.id}`, {labels: Object.keys(next).length > 0 ? next : null}, {'If-Match': '*'}).then(
      () => setTyped(null), error => { setSent(null); setProblem(error as Problem); });
  };
  return <>
    {typed === null ? <>{written(labels) || '–'} <button type="button" class="link no-print" onClick={() => { setTyped(written(labels)); setProblem(undefined); }}>Change<span class="visually-hidden"> labels</span></button></>
      : <form class="row" onSubmit={save}><input aria-label="Labels, name=value" placeholder="firmware=1.5.0" value={typed} onInput={event => setTyped(event.currentTarget.value)} onKeyDown={event => { if (event.key === 'Escape') setTyped(null); }} /><button class="btn">Save</button></form>}
    {problem && <Refusal problem={problem} />}
  </>;
}
