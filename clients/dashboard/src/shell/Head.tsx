// The head of a page: where it is, what it is, one line of facts, what can be done.
import type {ComponentChildren, JSX} from 'preact';
import {useEffect} from 'preact/hooks';
import {useRead} from '../api/client';
import type {Job, Summary} from '../api/documents';
import {writeSentence} from '../format/words';
import {usePlace} from '../route';

export function Head({crumb, title, facts, actions}: {crumb?: readonly (readonly [string, string | null])[]; title: string; facts: ComponentChildren[]; actions?: ComponentChildren}): JSX.Element {
  return <>
    {crumb && <nav class="crumb" aria-label="Place">{crumb.map(([text, href], i) => <span key={text}>{i > 0 && ' / '}{href ? <a href={href}>{text}</a> : text}</span>)}</nav>}
    <div class="head">
      <div><h1>{title}</h1><div class="meta">{facts.filter(Boolean).map((fact, i) => <span key={i}>{fact}</span>)}</div></div>
      {actions && <div class="actions">{actions}</div>}
    </div>
  </>;
}

export function Verdict({summary, children}: {summary: Summary; children?: ComponentChildren}): JSX.Element {
  return <p class="verdict">
    {summary.level === 'wrong' && <span class="g bad">✗ </span>}{writeSentence(summary.verdict)}
    {(summary.details.length > 0 || children) && <small>{summary.details.map(writeSentence).join(' ')}{children}</small>}
  </p>;
}

// The page as it is, on paper: what is folded is opened while it prints, and `?print=1` asks for it at once.
export function Report(): JSX.Element {
  const {query} = usePlace();
  const asked = query.get('print') === '1';
  useEffect(() => {
    let opened: HTMLDetailsElement[] = [];
    const open = (): void => { opened = [...document.querySelectorAll<HTMLDetailsElement>('main details:not([open])')]; for (const each of opened) each.open = true; };
    const close = (): void => { for (const each of opened) each.open = false; opened = []; };
    window.addEventListener('beforeprint', open);
    window.addEventListener('afterprint', close);
    return () => { window.removeEventListener('beforeprint', open); window.removeEventListener('afterprint', close); };
  }, []);
  useEffect(() => {
    if (!asked) return undefined;
    const timer = setInterval(() => { if (!document.querySelector('[aria-busy=true]')) { clearInterval(timer); window.print(); } }, 500);
    return () => clearInterval(timer);
  }, [asked]);
  return <button type="button" class="btn" onClick={() => window.print()}>Report</button>;
}

// What a report must say of the job that made a result; on paper only, for on the screen the job has its page.
export function MadeBy({job}: {job: string}): JSX.Element | null {
  const read = useRead<Job>(`/v1/jobs/${job}`);
  if (!read.data) return null;
  const {request} = read.data;
  const inputs = request.inputs.recordings ?? [];
  return <div class="print-only method"><h3>How it was made</h3><dl>
    <dt>job</dt><dd>{read.data.id}, {request.kind}</dd><dt>algorithm</dt><dd>version {request.algorithm_version}</dd><dt>seed</dt><dd>{request.parameters.seed ?? 1}</dd>
    <dt>parameters</dt><dd>{JSON.stringify(request.parameters)}</dd>
    {inputs.length > 0 && <><dt>recordings</dt><dd>{inputs.map(one => `${one.id} revision ${one.revision}`).join(', ')}</dd></>}
  </dl></div>;
}
