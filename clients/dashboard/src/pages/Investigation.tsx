// What the simulation gets wrong: causes with their sizes, what they mend, what is left, what was not examined.
import type {JSX} from 'preact';
import {useRead} from '../api/client';
import type {Device, List, Recording} from '../api/documents';
import {writeNumber} from '../format/number';
import {writeWhen} from '../format/time';
import {capital, countWord, listWords, plural, processName, writeSentence} from '../format/words';
import {Drawn} from '../figure/Drawn';
import {csvOf, save, type Table} from '../figure/export';
import {Tools} from '../figure/Figure';
import {choose, pageOf, usePlace} from '../route';
import {RunAgain} from '../shell/Again';
import {Head} from '../shell/Head';
import {MadeBy, Report} from '../shell/Report';
import {curlOf} from '../shell/copy';
import {Panel, Segments, Shown} from '../shell/states';
import {useTitle} from '../shell/title';
import {Checks} from './investigation/Checks';
import {Findings} from './investigation/Findings';
import {causeName, checkKind, columnOf, type Finding, type Investigation} from './investigation/documents';
import {Measured} from './investigation/Measured';
import {Unnamed} from './investigation/Unnamed';

// Grouped by cause, in the order of the document: as a laboratory would act on them.
function grouped(findings: readonly Finding[]): [string, Finding[]][] {
  const groups = new Map<string, Finding[]>();
  for (const finding of findings) groups.set(finding.cause, [...groups.get(finding.cause) ?? [], finding]);
  return [...groups];
}

// Investigations of before the summary have their sentence from what they hold.
function sentence(found: Investigation): string {
  if (found.summary) return found.summary.verdict;
  const {checks_failed_before: before, checks_failed_after: after} = found.gain;
  if (found.findings.length === 0) return before === 0 ? `${found.checks.length} checks, none failed. The simulation agrees with these recordings.` : `${before} of ${found.checks.length} checks fail, and no listed cause explains them.`;
  return `The simulation lacks ${listWords(grouped(found.findings).map(([cause]) => causeName(cause)))}; ${after} of ${before} failed checks still fail.`;
}

function NotExamined({found}: {found: Investigation}): JSX.Element {
  const needs = new Map<string, Set<string>>();
  for (const each of found.not_examined ?? []) needs.set(each.needs, (needs.get(each.needs) ?? new Set()).add(each.cause));
  const rows = [...needs].sort((a, b) => b[1].size - a[1].size);
  return <Panel title="Not examined" sub="what the next recording should hold">{rows.length === 0 ? <p class="sec">Every listed cause was examined.</p> : <table class="stacked"><thead><tr><th scope="col">needs</th><th scope="col">would decide</th><th scope="col" class="n">causes</th></tr></thead>
    <tbody>{rows.map(([need, causes]) => <tr key={need}><th scope="row">{capital(need)}</th><td class="sec">{[...causes].map(causeName).join(', ')}</td><td class="n">{causes.size}</td></tr>)}</tbody></table>}</Panel>;
}

const checkTable = (found: Investigation, names: ReadonlyMap<string, string>): Table => ({heading: ['recording', 'column', 'check', 'p', 'p corrected', 'failed', 'fails still'], rows: found.checks.map(check => [check.recording ? names.get(check.recording) ?? check.recording : 'whole study', columnOf(check.channel), checkKind(check), check.p, check.p_adjusted, check.failed ? 'yes' : 'no', check.failed_after ? 'yes' : 'no'])});

function Found({found}: {found: Investigation}): JSX.Element {
  const {query} = usePlace();
  const device = useRead<Device>(`/v1/devices/${found.device}`);
  const recordings = useRead<List<Recording>>(`/v1/recordings?device=${found.device}&limit=500`);
  const names = new Map((recordings.data?.items ?? []).map(one => [one.id, one.metadata.id ?? one.id] as const));
  const ids = new Set([...found.checks.map(check => check.recording), ...found.findings.flatMap(finding => finding.channels.map(channel => /^rec_[0-9A-Z]{26}/.exec(channel)?.[0]))].filter(Boolean));
  const {gain} = found;
  const outage = gain.outage_error_m;
  const groups = grouped(found.findings);
  const channels = found.figures ?? [];
  const shown = channels.find(one => one.channel === query.get('axis')) ?? channels[0];
  const title = `What the simulation gets wrong: ${device.data?.name ?? '…'}`;
  const table = (): void => save(`${found.id}-findings.csv`, 'text/csv', csvOf({heading: ['cause', 'status', 'channels', 'parameter', 'value', 'low', 'high', 'unit', 'score'], rows: found.findings.flatMap(finding => Object.entries(finding.parameters).map(([name, q]) => [finding.cause, finding.status, finding.channels.map(columnOf).join(' '), name, q.value, q.ci95?.[0] ?? null, q.ci95?.[1] ?? null, q.unit, finding.score ?? null]))}));
  // Also where nothing was found.
  const how = (): JSX.Element => <><p>Every listed cause is sought in the recordings, estimated, held out and compared with its rivals; checks compare the recordings with simulations of the baseline, corrected for their number. <a href="/docs/analysis">The manual</a> tells how.</p><RunAgain job={found.job} /></>;
  useTitle(title);
  const causes = new Set((found.not_examined ?? []).map(each => each.cause)).size;
  return <>
    <Head crumb={[['Investigations', '/investigations'], [device.data?.name ?? '…', device.data ? pageOf('devices', device.data.name) : null]]} title={title}
      facts={[plural(ids.size, 'recording'), found.baseline.processes.length > 0 && `baseline ${found.baseline.processes.map(process => processName(process.process)).join(' + ')}`, writeWhen(found.created_at)]}
      actions={<>{found.model && <><a class="btn" href={`/compare?with=${[found.baseline_model, found.model].filter(Boolean).join(',')}`}>Compare models</a><a class="btn" href={pageOf('models', found.model)}>Extended model</a></>}<a class="btn" href={pageOf('jobs', found.job)}>Job</a><Report /></>} />
    <p class="verdict">{sentence(found)}<small>{(found.summary?.details ?? found.unexplained.map(one => one.explanation)).map(writeSentence).join(' ')} {causes > 0 ? `${capital(countWord(causes))} cause${causes === 1 ? '' : 's'} could not be examined with these recordings.` : ''}</small></p>
    <section class="panel figures4">
      <div><span class="sec">failed checks, of {found.checks.length}</span><strong>{gain.checks_failed_before} → {gain.checks_failed_after}</strong><span class="u">5 % false alarms over all of them together</span></div>
      <div><span class="sec">misfit explained</span><strong>{typeof gain.explained === 'number' && found.findings.length > 0 ? `${Math.round(100 * gain.explained)} %` : '–'}</strong><span class="u">on samples the findings were not fitted to</span></div>
      <div><span class="sec">outage error, 10 s</span><strong>{outage.baseline === null ? '–' : `${writeNumber(outage.baseline, 2)} m → ${writeNumber(outage.adopted ?? outage.extended, 2)} m`}</strong><span class="u">{outage.baseline === null ? 'no axis of an inertial unit' : 'two outages, as each model predicts'}</span></div>
      <div><span class="sec">causes not examined</span><strong>{causes}</strong><span class="u">what the next recording decides, below</span></div>
    </section>
    {channels.length > 1 && <p class="row" style={{marginTop: '16px'}}><Segments label="Channel" options={channels.map(one => [one.channel, columnOf(one.channel)] as const)} value={shown?.channel ?? ''} onChange={value => choose({axis: value})} /></p>}
    {shown && <Measured found={found} one={shown} names={names} />}
    {groups.map(([cause, list], i) => <Panel key={cause} title={capital(causeName(cause))} sub={`${list.every(finding => finding.status === 'identified') ? 'identified' : 'ambiguous'} · ${plural(list.length, 'finding')}`} tools={i === 0 ? <Tools title="The search" onCsv={table} curl={curlOf(`/v1/investigations/${found.id}`)} how={how} /> : undefined}>
      <Findings list={list} found={found} names={names} total={ids.size} />
    </Panel>)}
    <Unnamed found={found} />
    <div class="grid two">
      <Drawn name={`${found.id}-checks`} title="Checks" sub={`${found.checks.length} made, ${gain.checks_failed_before} failed`} source={`driftlab, ${found.id}`} curl={curlOf(`/v1/investigations/${found.id}`)} how={how} table={() => checkTable(found, names)}><Checks found={found} names={names} /></Drawn>
      <NotExamined found={found} />
    </div>
    {(found.notes ?? []).map(note => <p key={note} class="note">{note}</p>)}
    <MadeBy job={found.job} document={`/v1/investigations/${found.id}`} />
  </>;
}

export default function InvestigationPage(): JSX.Element {
  const {parts} = usePlace();
  const read = useRead<Investigation>(`/v1/investigations/${encodeURIComponent(parts[1] ?? '')}`);
  useTitle('Investigation');
  return <Shown read={read} page="Investigation">{found => <Found found={found} />}</Shown>;
}
