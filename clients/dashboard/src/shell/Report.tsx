// A page on paper: a report is the page itself, laid out as wide as the paper, with what a reader needs to repeat it.
import type {JSX} from 'preact';
import {useEffect, useState} from 'preact/hooks';
import {ask, useRead} from '../api/client';
import type {Job, Recording} from '../api/documents';
import {usePlace} from '../route';

// --- the page as it is, on paper: what is folded is opened, and all is laid out as wide as the paper before figures are drawn
let folded: HTMLDetailsElement[] = [];
const readers = new Set<(on: boolean) => void>();
function onto(): void {
  folded = [...folded, ...document.querySelectorAll<HTMLDetailsElement>('main details:not([open]):not([data-stays])')];
  for (const each of folded) each.open = true;
  document.documentElement.classList.add('paper');
  for (const tell of [...readers]) tell(true);
}
function off(): void {
  for (const each of folded) each.open = false;
  folded = [];
  document.documentElement.classList.remove('paper');
  for (const tell of [...readers]) tell(false);
}
const LAID_OUT_MS = 300;  // for figures to be drawn again, and for what only a report reads to be asked for
const calm = (): boolean => !document.querySelector('[aria-busy=true]');
function printed(): void {
  onto();
  const timer = setInterval(() => { if (calm()) { clearInterval(timer); setTimeout(() => window.print(), LAID_OUT_MS); } }, LAID_OUT_MS);
}

// Whether the page lies on paper: then it reads what only a report shows.
export function usePaper(): boolean {
  const [paper, setPaper] = useState(() => document.documentElement.classList.contains('paper'));
  useEffect(() => { readers.add(setPaper); setPaper(document.documentElement.classList.contains('paper')); return () => { readers.delete(setPaper); }; }, []);
  return paper;
}

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
    const timer = setInterval(() => { if (calm()) { clearInterval(timer); printed(); } }, 500);
    return () => clearInterval(timer);
  }, [asked]);
  return <button type="button" class="btn" onClick={printed}>Report</button>;
}

// --- what a report must say beside the page
const made = ({request}: Job): string => `${request.kind}, algorithm version ${request.algorithm_version}, seed ${request.parameters.seed ?? 1}`;

// One recording that a result rests on: its file by its hash, and on request the job that characterised it.
function Input({id, revision, withJob}: {id: string; revision?: number | undefined; withJob: boolean}): JSX.Element {
  const recording = useRead<Recording>(`/v1/recordings/${id}`);
  const job = useRead<Job>(withJob && recording.data?.latest_job ? `/v1/jobs/${recording.data.latest_job}` : null);
  const {data} = recording;
  return <><dt aria-busy={recording.loading || job.loading}>{data?.metadata.id ?? id}</dt>
    <dd>{data ? <>{id} revision {revision ?? data.revision}, SHA-256 <code>{data.file.sha256}</code>{withJob && job.data && <>, {made(job.data)}, job {job.data.id}</>}</> : recording.problem ? 'no longer stored' : '…'}</dd></>;
}

// The recordings of a page's results.
export function MadeFrom({recordings}: {recordings: readonly string[]}): JSX.Element | null {
  if (!usePaper() || recordings.length === 0) return null;
  return <div class="print-only method foot made-from"><h3>How it was made</h3><dl class="one">{recordings.map(id => <Input key={id} id={id} withJob />)}</dl></div>;
}

// The hash by which the daemon names the content of a document: `curl -I` of its address gives the same.
function Hash({path}: {path: string}): JSX.Element {
  const [hash, setHash] = useState<string>();
  useEffect(() => { ask(path, {headers: {Accept: 'application/json'}}).then(answer => setHash((answer.headers.get('ETag') ?? '–').replace(/^W\/|"|-gzip/g, '')), () => setHash('–')); }, [path]);
  return <><dt aria-busy={hash === undefined}>document</dt><dd>{path}, hash <code>{hash ?? '…'}</code></dd></>;
}

// The job that made a result, what it read and what it wrote; on the screen the job has its page.
export function MadeBy({job, document}: {job: string; document: string}): JSX.Element | null {
  const paper = usePaper();
  const read = useRead<Job>(paper ? `/v1/jobs/${job}` : null);
  if (!paper) return null;
  if (!read.data) return <div class="print-only" aria-busy={read.loading} />;
  const {request} = read.data;
  const inputs = request.inputs.recordings ?? [];
  return <div class="print-only method"><h3>How it was made</h3><dl class="one">
    <dt>job</dt><dd>{read.data.id}, {made(read.data)}</dd>
    <dt>parameters</dt><dd>{JSON.stringify(request.parameters)}</dd>
    <Hash path={document} />
    {inputs.map(one => <Input key={one.id} id={one.id} revision={one.revision} withJob={false} />)}
  </dl></div>;
}
