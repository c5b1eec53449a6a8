// What error models are worth in navigation: error, gain, honesty.
import {scaleLinear} from 'd3-scale';
import type {JSX} from 'preact';
import {useJobEvents, useRead} from '../api/client';
import type {Quantity} from '../api/documents';
import {writeNumber, writeQuantity, writeShare, writeTick} from '../format/number';
import {writeDuration, writeWhen} from '../format/time';
import {plural, writeSentence} from '../format/words';
import {csvOf, save} from '../figure/export';
import {curlOf, Tools, useWidth} from '../figure/Figure';
import {choose, usePlace} from '../route';
import {Head, MadeBy, Report, Verdict} from '../shell/Head';
import {usePageKeys} from '../shell/keys';
import {Panel, Progress, Segments, Shown} from '../shell/states';
import {useTitle} from '../shell/title';
import type {Evaluation, Filter, StoredEvaluation} from './outage/documents';
import {Frame, reachOf} from './outage/Frames';
import {DriveMap} from './outage/Map';

const ROW = 36;
const HONEST = 2;

function Dots({filters, pick, most, title, colours}: {filters: Filter[]; pick: (filter: Filter) => Quantity; most: number; title: string; colours: string[]}): JSX.Element {
  const [box, width] = useWidth();
  const x = (value: number): number => 4 + value / most * (width - 40);
  const height = filters.length * ROW + 20;
  const ticks = scaleLinear().domain([0, most]).ticks(Math.max(1, Math.floor(width / 50)));
  return <div ref={box}><div class="u"><b>{title}</b></div><svg width={width} height={height} aria-hidden="true">
    {ticks.map(tick => <g key={tick}><line class={tick === 0 ? 'ax' : 'gr'} x1={x(tick)} x2={x(tick)} y1="0" y2={height - 18} /><text class="s" x={x(tick)} y={height - 5} text-anchor={tick === 0 ? 'start' : 'middle'}>{tick === 0 ? '0 m' : writeTick(tick)}</text></g>)}
    {filters.map((filter, i) => { const value = pick(filter); const [low, high] = value.ci95 ?? []; const y = i * ROW + ROW / 2; return <g key={filter.name}>
      {low !== null && low !== undefined && high !== null && high !== undefined && <line x1={x(low)} x2={x(high)} y1={y} y2={y} stroke={colours[i]} stroke-width="1.6" />}
      <circle cx={x(value.value ?? 0)} cy={y} r="4" fill={colours[i]} /><text x={x(high ?? value.value ?? 0) + 7} y={y + 4}>{writeQuantity(value).value}</text></g>; })}
  </svg></div>;
}

function Nees({filters, colours}: {filters: Filter[]; colours: string[]}): JSX.Element {
  const [box, width] = useWidth();
  const values = filters.flatMap(filter => [filter.nees, ...filter.outages.map(one => one.nees)]);
  const low = Math.min(1, ...values) / 1.1;
  const high = Math.max(4, ...values) * 1.1;
  const x = (value: number): number => 6 + Math.log(value / low) / Math.log(high / low) * (width - 12);
  const ticks = [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000].filter(tick => tick >= low && tick <= high);
  const height = filters.length * ROW + 20;
  return <div ref={box}><svg width={width} height={height} aria-hidden="true">
    {ticks.map(tick => <g key={tick}><line class={tick === HONEST ? 'ax' : 'gr'} x1={x(tick)} x2={x(tick)} y1="0" y2={height - 18} /><text class="s" x={x(tick)} y={height - 5} text-anchor="middle">{tick}</text></g>)}
    {filters.map((filter, i) => { const y = i * ROW + ROW / 2; const [a, b] = filter.nees_ci95; return <g key={filter.name}>
      {filter.outages.map(one => <circle key={one.index} cx={x(one.nees)} cy={y} r="3" fill="var(--surface)" stroke={colours[i]} stroke-width="1.2" />)}
      {a !== null && a !== undefined && b && <line x1={x(Math.max(a, low))} x2={x(b)} y1={y} y2={y} stroke={colours[i]} stroke-width="1.8" />}<circle cx={x(filter.nees)} cy={y} r="4" fill={colours[i]} /></g>; })}
  </svg></div>;
}

function Staircase({evaluation, from}: {evaluation: Evaluation; from: Filter | undefined}): JSX.Element | null {
  const {attribution} = evaluation;
  if (!attribution || !from) return <p class="sec">The scenario lacks the filters between which the gain could be shared out.</p>;
  const steps = [['low-frequency noise in the filter', attribution.low_frequency_noise], ['Gauss-Markov states', attribution.gauss_markov_states], ['following the rate', attribution.switching]] as const;
  const start = from.mean_error_m.value ?? 0;
  let level = start;
  const stairs = steps.map(([name, pair]) => { const before = level; level += pair.difference_m.value ?? 0; return {name, pair, before, after: level}; });
  const [low, high] = [Math.min(level, ...stairs.map(each => each.after)), Math.max(start, ...stairs.map(each => each.before))];
  const width = 620;
  const x = (value: number): number => 210 + (value - low) / Math.max(high - low, 1e-9) * (width - 400);
  return <div class="scroll" tabIndex={0} role="region" aria-label="Staircase"><svg viewBox={`0 0 ${width} ${32 * (stairs.length + 1) + 26}`} class="staircase" width="100%" role="img" aria-label={`From ${writeNumber(start)} m with ${from.name}: ${stairs.map(each => `${each.name} ${writeQuantity(each.pair.difference_m).value} m`).join(', ')}.`}>
    <text class="t" x="0" y="20">{from.name}</text><circle cx={x(start)} cy="16" r="4.5" fill="var(--robust)" /><text x={x(start) + 10} y="20">{writeQuantity(from.mean_error_m).value} m</text>
    {stairs.map((each, i) => { const y = 32 * (i + 1) + 16; const written = writeQuantity(each.pair.difference_m); return <g key={each.name}>
      <line class="ax" x1={x(each.before)} x2={x(each.before)} y1={y - 32} y2={y} /><text class="t" x="0" y={y + 4}>{each.name}</text>
      <line x1={x(each.before)} x2={x(each.after)} y1={y} y2={y} stroke="var(--ink)" stroke-width="5" /><text x={Math.max(x(each.before), x(each.after)) + 10} y={y + 4}>{written.value} m {written.interval}</text></g>; })}
  </svg></div>;
}

function Found({stored, evaluation}: {stored: StoredEvaluation; evaluation: Evaluation}): JSX.Element {
  const {query} = usePlace();
  const ranked = [...evaluation.filters].sort((a, b) => (a.mean_error_m.value ?? 0) - (b.mean_error_m.value ?? 0));
  const named = (name: string | null, otherwise: Filter): Filter => evaluation.filters.find(filter => filter.name === name) ?? otherwise;
  const left = named(query.get('left'), evaluation.filters.find(filter => filter.name === 'M_stat(AV)') ?? ranked[ranked.length - 1]!);
  const right = named(query.get('right'), ranked[0]!);
  const count = left.outages.length;
  const outage = Math.min(Math.max(Number(query.get('outage') ?? 1), 1), count) - 1;
  const step = (by: number): void => choose({outage: String((outage + by + count) % count + 1)});
  usePageKeys({'[': () => step(-1), ']': () => step(1)});
  const colours = ranked.map(filter => filter === right ? 'var(--model)' : filter === left ? 'var(--robust)' : 'var(--measured)');
  const most = Math.max(...evaluation.filters.flatMap(filter => filter.outages.map(one => one.error_m.ci95?.[1] ?? one.error_m.value ?? 0))) * 1.15;
  const reach = reachOf([left, right], outage);
  const table = (): void => save('outage-errors.csv', 'text/csv', csvOf({heading: ['filter', 'outage', 'error_m', 'low_m', 'high_m', 'nees', 'coverage95'], rows: evaluation.filters.flatMap(filter => filter.outages.map(one => [filter.name, one.index, one.error_m.value, one.error_m.ci95?.[0] ?? null, one.error_m.ci95?.[1] ?? null, one.nees, one.coverage95]))}));
  const choice = (side: 'left' | 'right', value: Filter): JSX.Element => <label class="nowrap">{side} <select value={value.name} onChange={event => choose({[side]: event.currentTarget.value})}>{evaluation.filters.map(filter => <option key={filter.name}>{filter.name}</option>)}</select></label>;
  return <>
    {evaluation.summary && <Verdict summary={evaluation.summary} />}
    <div class="grid side-main">
      <Panel title="Drive" sub={`${writeDuration(evaluation.trajectory.time_s[evaluation.trajectory.time_s.length - 1] ?? 0)}, outage ${outage + 1} enlarged`}><DriveMap evaluation={evaluation} outage={outage} left={left} right={right} /></Panel>
      <Panel title={`Outage ${outage + 1}, end`} controls={<Segments label="Outage" options={left.outages.map(one => [String(one.index), String(one.index)] as const)} value={String(outage + 1)} onChange={value => choose({outage: value})} />} sub={<>{evaluation.runs} runs · solid: the filter’s own 95 %, dashed: what happened</>} tools={<div class="tools">{choice('left', left)}{choice('right', right)}</div>}>
        <div class="grid two no-top"><Frame filter={left} outage={outage} reach={reach} colour="var(--robust)" /><Frame filter={right} outage={outage} reach={reach} colour="var(--model)" /></div>
        <p class="note">Cross at the true position, north up.</p>
      </Panel>
    </div>
    <div class="grid wide-side">
      <section class="panel"><div class="ptop"><h2>Horizontal error by filter</h2><span class="sub">mean over runs, 95 %</span><Tools title="The error" onCsv={table} curl={curlOf(`/v1/outage-evaluations/${stored.id}`)} how={() => <p>Every filter sees the same simulated drives. The error is that of the horizontal position at the end of an outage. <a href="/docs/navigation">The manual</a> describes scenario, filters and intervals. Seed {evaluation.seed}, algorithm {evaluation.algorithm_version}.</p>} /></div>
        <div class="outage-dots scroll"><div><div class="u">&nbsp;</div>{ranked.map((filter, i) => <div key={filter.name} style={{height: `${ROW}px`, lineHeight: `${ROW}px`, color: colours[i] === 'var(--measured)' ? undefined : colours[i]}} title={filter.about} class="nowrap">{filter.name}</div>)}</div>
          <Dots filters={ranked} pick={filter => filter.mean_error_m} most={most} title={`mean of ${count}`} colours={colours} />
          {left.outages.map((one, i) => <Dots key={one.index} filters={ranked} pick={filter => filter.outages[i]!.error_m} most={most} title={`outage ${one.index}`} colours={colours} />)}</div>
        <div class="visually-hidden"><table><caption>Mean horizontal error</caption><tbody>{ranked.map(filter => <tr key={filter.name}><th scope="row">{filter.name}</th><td>{writeQuantity(filter.mean_error_m).value} m {writeQuantity(filter.mean_error_m).interval}, NEES {writeNumber(filter.nees, 2)}, holds {writeShare(filter.coverage95)}</td></tr>)}</tbody></table></div>
      </section>
      <Panel title="Does the filter know" sub="NEES, 2 is honest: ● mean, ○ each outage"><div class="nees"><div>{ranked.map(filter => <div key={filter.name} style={{height: `${ROW}px`, lineHeight: `${ROW}px`}} class="nowrap">{filter.name}</div>)}</div><Nees filters={ranked} colours={colours} /><div>{ranked.map(filter => <div key={filter.name} style={{height: `${ROW}px`, lineHeight: `${ROW}px`}} class="n">{writeShare(filter.coverage95)}</div>)}<div class="u">holds</div></div></div></Panel>
    </div>
    <div class="grid wide-side">
      <Panel title="Where the gain comes from" sub="paired differences, same data for every filter"><Staircase evaluation={evaluation} from={evaluation.filters.find(filter => filter.name === evaluation.attribution?.total.against)} /><p class="note">Intervals are of the paired difference, so they are far narrower than those of the errors themselves.</p></Panel>
      {evaluation.claims.length > 0 && <Panel title="What the paper claims" sub={`${evaluation.claims.filter(claim => claim.supported).length} of ${evaluation.claims.length} supported`}><ul class="rows">{evaluation.claims.map(claim => <li key={claim.claim}><span class="nowrap"><span class={`g ${claim.supported ? 'good' : 'bad'}`} aria-hidden="true">{claim.supported ? '✓' : '✗'} </span><b>{claim.supported ? 'supported' : 'not supported'}</b></span><span class="grow">{claim.claim}<div class="u">{writeSentence(claim.because)}</div></span></li>)}</ul></Panel>}
    </div>
  </>;
}

export default function OutagePage(): JSX.Element {
  const {parts} = usePlace();
  const read = useRead<StoredEvaluation>(`/v1/outage-evaluations/${encodeURIComponent(parts[1] ?? '')}`);
  useJobEvents(read.data && !read.data.finished_at ? read.data.id : null, read.again);
  useTitle(read.data ? `Outages: ${read.data.scenario_name}` : 'Outages');
  return <Shown read={read}>{stored => <>
    <Head crumb={[['Outages', '/outages'], [stored.scenario_name, null]]} title={`Simulated outages: ${stored.scenario_name}`}
      facts={[stored.evaluation && plural(stored.evaluation.filters[0]?.outages.length ?? 0, 'outage'), stored.evaluation && plural(stored.evaluation.filters.length, 'filter'), `${plural(stored.evaluation?.runs ?? stored.runs, 'run')}, seed ${stored.seed}`, stored.finished_at ? `${writeWhen(stored.finished_at)}, took ${writeDuration((Date.parse(stored.finished_at) - Date.parse(stored.created_at)) / 1000)}` : 'running']} actions={<><a class="btn" href={`/jobs/${stored.id}`}>Job</a><Report /></>} />
    <MadeBy job={stored.id} />
    {stored.evaluation ? <Found stored={stored} evaluation={stored.evaluation} /> : <><p class="verdict" role="status">{stored.problem ? <><span class="g bad" aria-hidden="true">✗ </span>{stored.problem.detail}</> : stored.finished_at ? `The job was ${stored.state}; there is no result.` : `${stored.stage ?? 'Waiting for a worker'}, ${Math.round(stored.progress * 100)} %`}</p>{!stored.finished_at && <Progress share={stored.progress} label="Outages" />}</>}
  </>}</Shown>;
}
