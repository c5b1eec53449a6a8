// The lab: what must be read today, what runs, and whether each device is like its siblings.
import type {JSX} from 'preact';
import {useEffect, useState} from 'preact/hooks';
import {useRead} from '../api/client';
import type {Attention, AxisSummary, Counts, Device, Job, List} from '../api/documents';
import {writeTick, writeQuantity} from '../format/number';
import {writeToday, writeWhen} from '../format/time';
import {capital, conditionName, countWord, jobKind, plural, writeUnit} from '../format/words';
import {MarkAt} from '../figure/MarkAt';
import {decadeTicks, logarithmic} from '../figure/scale';
import type {Mark} from '../figure/spec';
import {choose, pageOf, usePlace} from '../route';
import {Head} from '../shell/Head';
import {LastResult, pageOfResult} from '../shell/LastResult';
import {Sought} from '../shell/Sought';
import {curlOf, copy} from '../shell/copy';
import {Pager} from '../shell/Pager';
import {Hairlines, Panel, Progress, Refusal, Segments} from '../shell/states';
import {useTitle} from '../shell/title';

const MARKS: Record<string, Mark> = {x: 'dot', y: 'square', z: 'triangle'};
const PAGE = 50;
const SHOWN = 8;
const SEEN = 'driftlab-seen';  // until when results to read were marked as seen, in this browser alone

interface Item { who: string; href: string; text: string; at: string; bad: boolean }

// Results whose verdict is not fine, and jobs that failed, newest first.
function toRead(attention: readonly Attention[], jobs: readonly Job[]): Item[] {
  const items: Item[] = attention.map(item => ({who: item.device_name ?? capital(jobKind(item.kind)), href: pageOfResult(item), text: `${item.channel ? `${item.channel}: ` : ''}${item.verdict}`, at: item.created_at, bad: item.level === 'wrong'}));
  for (const job of jobs) {
    if (job.state === 'failed' || job.state === 'dead') items.push({who: capital(jobKind(job.kind)), href: pageOf('jobs', job.id), text: job.problem?.detail ?? 'The job failed.', at: job.finished_at ?? job.created_at, bad: true});
  }
  return items.sort((a, b) => a.at < b.at ? 1 : -1).slice(0, SHOWN);
}

function opening(counts: Counts, wants: number, seen: boolean): string {
  const results = counts.jobs.succeeded_since?.count ?? 0;
  const failed = counts.jobs.failed_since?.count ?? 0;
  const made = results === 0 ? 'No result today' : `${capital(countWord(results))} result${results === 1 ? '' : 's'} today`;
  return `${made}, ${failed === 0 ? 'none' : countWord(failed)} failed. ${wants === 0 ? seen ? 'Nothing new wants a look.' : 'Nothing wants a look.' : `${capital(countWord(wants))}${wants >= SHOWN ? ' or more' : ''} want${wants === 1 ? 's' : ''} a look.`}`;
}

interface Scale { (value: number): number; ticks: number[] }

function levelScale(values: number[], width: number): Scale {
  const low = Math.min(...values) / 1.4;
  const high = Math.max(...values) * 1.4;
  const ticks = decadeTicks(low, high, [1, 2, 5]);
  return Object.assign(logarithmic(low, high, 10, width - 10), {ticks: ticks.length > 7 ? ticks.filter(tick => /^1/.test(tick.toExponential())) : ticks});
}

const WIDTH = 460;

function Levels({channels, scale}: {channels: readonly AxisSummary[]; scale: Scale | null}): JSX.Element {
  if (!scale) return <svg viewBox={`0 0 ${WIDTH} 34`} width="100%" aria-hidden="true" />;
  const known = channels.filter(channel => channel.N && channel.N.value !== null);
  return <svg viewBox={`0 0 ${WIDTH} 34`} width="100%" height="34" preserveAspectRatio="xMinYMid meet" aria-hidden="true">
    {scale.ticks.map(tick => <line key={tick} class="gr" x1={scale(tick)} x2={scale(tick)} y1="0" y2="34" />)}
    {known.map((channel, i) => {
      const y = 17 + (i - (known.length - 1) / 2) * 9;
      const [low, high] = channel.N!.ci95 ?? [];
      return <g key={i}>
        {low && high && low > 0 && <line x1={scale(low)} x2={scale(high)} y1={y} y2={y} stroke="var(--ink)" stroke-width="1.3" />}
        <MarkAt mark={MARKS[channel.axis ?? ''] ?? 'dot'} x={scale(channel.N!.value!)} y={y} colour="var(--ink)" size={3.2} />
      </g>;
    })}
  </svg>;
}

function conditionsOf(device: Device): string {
  const conditions = device.summary?.conditions ?? [];
  const of = (kind: string): number => conditions.filter(one => one.condition?.kind === kind).length;
  const words = conditions.filter(one => !['constant_rate', 'constant_angular_acceleration', 'six_position'].includes(one.condition?.kind ?? '')).map(one => conditionName(one.condition));
  if (of('constant_rate') > 0) words.push(plural(of('constant_rate'), 'rate'));
  if (of('constant_angular_acceleration') > 0) words.push(plural(of('constant_angular_acceleration'), 'acceleration'));
  if (of('six_position') > 0) words.push(plural(of('six_position'), 'position'));
  return words.join(', ') || '–';
}

function Devices({devices, next}: {devices: readonly Device[]; next: string | null}): JSX.Element {
  const {query} = usePlace();
  const quantity = query.get('sensor') === 'accelerometer' ? 'specific_force' : 'angular_rate';
  const of = (device: Device): AxisSummary[] => (device.summary?.channels ?? []).filter(channel => channel.quantity === quantity);
  const ends = devices.flatMap(device => of(device).flatMap(channel => channel.N && channel.N.value !== null && channel.N.value > 0 ? [channel.N.value, ...(channel.N.ci95 ?? []).filter((x): x is number => x !== null && x > 0)] : []));
  const scale = ends.length > 0 ? levelScale(ends, WIDTH) : null;
  const unit = devices.flatMap(of).find(channel => channel.N)?.N?.unit;
  return <Panel title="Devices" sub={<>white noise N at rest{unit ? `, ${writeUnit(unit)}` : ''}, 95 %: ● x □ y ▲ z</>}
    controls={<Segments label="Sensor" options={[['gyroscope', 'Gyroscopes'], ['accelerometer', 'Accelerometers']] as const} value={quantity === 'specific_force' ? 'accelerometer' : 'gyroscope'} onChange={value => choose({sensor: value === 'gyroscope' ? null : value})} />}
    tools={<div class="tools"><Sought label="Only names and models with" /><label class="nowrap">order <select value={query.get('sort') ?? ''} onChange={event => choose({sort: event.currentTarget.value || null, after: null})}><option value="">newest first</option><option value="name">by name</option></select></label>
      <button type="button" class="quiet" onClick={() => copy(curlOf('/v1/devices?include=summary'), 'The command is')}>curl</button></div>}>
    <div class="scroll"><table class="stacked">
      <thead><tr><th scope="col">device</th><th scope="col" class="n">recordings</th><th scope="col">conditions</th><th scope="col" class="desk-only">white noise N</th><th scope="col">x, y, z</th><th scope="col">last result</th></tr></thead>
      <tbody>{devices.length === 0 && <tr><td colSpan={6} class="sec">No device has “{query.get('q')}” in its name, model or serial.</td></tr>}{devices.map(device => {
        const channels = of(device);
        return <tr key={device.id}>
          <th scope="row" class="who"><a href={pageOf('devices', device.name)}>{device.name}</a></th>
          <td class="n" data-label="recordings">{device.summary?.recordings ?? '–'}</td>
          <td class="sec">{conditionsOf(device)}</td>
          <td class="desk-only" style={{width: '34%'}}><Levels channels={channels} scale={scale} /></td>
          <td class="nowrap" data-label="N">{channels.length > 0 ? channels.map(channel => channel.N ? writeQuantity(channel.N).value : '…').join(', ') : '–'}</td>
          <td class="sec"><LastResult device={device} /></td>
        </tr>;
      })}
      {scale && <tr class="desk-only axis" aria-hidden="true"><td /><td /><td /><td><svg viewBox={`0 0 ${WIDTH} 18`} width="100%" height="18" preserveAspectRatio="xMinYMid meet">{scale.ticks.map(tick => <text key={tick} class="s" x={scale(tick)} y="13" text-anchor="middle">{writeTick(tick)}</text>)}</svg></td><td /><td /></tr>}
      </tbody>
    </table></div>
    <Pager next={next} back="First" on={`Next ${PAGE}`} />
  </Panel>;
}

function Running({jobs}: {jobs: readonly Job[]}): JSX.Element {
  const running = jobs.filter(job => job.state === 'running');
  const waiting = jobs.filter(job => job.state === 'queued').length;
  return <Panel title="Running" tools={<div class="tools"><a href="/jobs">All jobs</a></div>}>
    {running.map(job => <div key={job.id}><div class="row"><a href={pageOf('jobs', job.id)}>{capital(jobKind(job.kind))}</a><span class="sec">{job.stage}</span><span class="right sec">{Math.round(job.progress * 100)} %</span></div><Progress share={job.progress} label={jobKind(job.kind)} /></div>)}
    <p class="sec">{running.length === 0 ? 'Nothing runs. ' : ''}{waiting === 0 ? 'Nothing waits.' : `${plural(waiting, 'job')} wait${waiting === 1 ? 's' : ''}.`}</p>
  </Panel>;
}

// It comes with the page of uploads, which a lab that is not empty does not need first.
function Empty(): JSX.Element {
  const [Page, setPage] = useState<() => JSX.Element>();
  useEffect(() => { import('../routes/lists').then(pages => setPage(() => pages.EmptyLab), () => window.location.reload()); }, []);
  return Page ? <Page /> : <Hairlines />;
}

export default function Lab(): JSX.Element {
  const {query} = usePlace();
  useTitle('Lab');
  const counts = useRead<Counts>(`/v1/counts?include=attention&since=${new Date().toISOString().slice(0, 10)}T00:00:00Z`, 5000);
  const after = query.get('after');
  const q = query.get('q');
  const sort = query.get('sort') === 'name' ? 'name' : '-created_at';
  const devices = useRead<List<Device>>(`/v1/devices?include=summary&sort=${sort}&limit=${PAGE}${q ? `&q=${encodeURIComponent(q)}` : ''}${after ? `&cursor=${after}` : ''}`, 3000);
  const jobs = useRead<List<Job>>('/v1/jobs?sort=-created_at&limit=50', 3000);
  const [seen, setSeen] = useState(() => localStorage.getItem(SEEN) ?? '');
  if (devices.data?.items.length === 0 && !after && !q) return <Empty />;
  const list = devices.data?.items ?? [];
  const recent = jobs.data?.items ?? [];
  const all = toRead(counts.data?.attention ?? [], recent);
  const wants = all.filter(item => item.at > seen);
  const mark = (until: string): void => { localStorage.setItem(SEEN, until); setSeen(until); };
  const known = counts.data && jobs.data;
  const refused = [counts, jobs].find(read => read.problem);
  const unread = refused ? <Refusal problem={refused.problem!} again={refused.again} /> : <Hairlines />;
  return <>
    <Head title="Lab" facts={[counts.data && plural(counts.data.devices, 'device'), counts.data && plural(counts.data.recordings, 'recording'), writeToday(new Date())]} actions={<a class="btn" href="/record">Record this phone</a>} />
    {known && counts.data && <p class="verdict">{opening(counts.data, wants.length, all.length > 0)}</p>}
    <div class="grid wide-side">
      <Panel title="Wants a look" sub={wants.length > 0 ? `newest ${wants.length}` : ''}
        tools={all.length > 0 && <div class="tools">{wants.length > 0 ? <button type="button" class="quiet" onClick={() => mark(wants[0]!.at)}>Mark all seen</button>
          : <button type="button" class="quiet" onClick={() => mark('')}>Show what was seen</button>}</div>}>
        {!known ? unread : wants.length === 0 ? <p class="sec">{all.length > 0 ? 'Nothing that was not seen.' : 'Nothing. Every newest result is fine, and no job failed.'}</p> : <ul class="rows looks">{wants.map(item => <li key={item.href}>
          <span class="nowrap"><span class={`g ${item.bad ? 'bad' : 'warn'}`} aria-hidden="true">{item.bad ? '✗' : '△'} </span><b>{item.who}</b></span>
          <span class="grow"><a href={item.href}>{item.text}</a></span><span class="dim nowrap">{writeWhen(item.at)}</span></li>)}</ul>}
      </Panel>
      {jobs.data ? <Running jobs={recent} /> : <Panel title="Running">{unread}</Panel>}
    </div>
    {devices.data ? <Devices devices={list} next={devices.data.next_cursor} /> : devices.problem ? <Panel title="Devices"><Refusal problem={devices.problem} again={devices.again} /></Panel> : <Panel title="Devices"><Hairlines /></Panel>}
  </>;
}
