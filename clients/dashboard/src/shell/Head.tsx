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

// --- the page as it is, on paper: what is folded is opened, and all is laid out as wide as the paper before figures are drawn
let folded: HTMLDetailsElement[] = [];
function onto(): void {
  folded = [...folded, ...document.querySelectorAll<HTMLDetailsElement>('main details:not([open]):not([data-stays])')];
  for (const each of folded) each.open = true;
  document.documentElement.classList.add('paper');
}
function off(): void {
  for (const each of folded) each.open = false;
  folded = [];
  document.documentElement.classList.remove('paper');
}
const LAID_OUT_MS = 300;  // for figures to be drawn again
const printed = (): void => { onto(); setTimeout(() => window.print(), LAID_OUT_MS); };

// `?print=1` asks for it at once, and stays on paper.
export function Report(): JSX.Element {
  const {query} = usePlace();
  const asked = query.get('print') === '1';
  useEffect(() => {
    const leave = (): void => { if (!asked) off(); };
    window.addEventListener('beforeprint', onto);
    window.addEventListener('afterprint', leave);
    return () => { window.removeEventListener('beforeprint', onto); window.removeEventListener('afterprint', leave); off(); };
  }, [asked]);
  useEffect(() => {
    if (!asked) return undefined;
    onto();
    const timer = setInterval(() => { if (!document.querySelector('[aria-busy=true]')) { clearInterval(timer); printed(); } }, 500);
    return () => clearInterval(timer);
  }, [asked]);
  return <button type="button" class="btn" onClick={printed}>Report</button>;
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
