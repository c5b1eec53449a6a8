// What stands beside the figure: parameters, ranking, Allan coefficients, other names of N, the file.
import type {JSX} from 'preact';
import type {Channel, Characterisation, ModelFit, Quantity, Recording} from '../../api/documents';
import {writeBytes, writeCount, writeNumber, writeP, writeQuantity} from '../../format/number';
import {writeFull} from '../../format/time';
import {conventionName, processName, symbolOf, writeSentence, writeUnit} from '../../format/words';
import {copy} from '../../shell/copy';
import {Panel} from '../../shell/states';
import {LabelsOf} from './Labels';
import {styleOf} from './plots';

function Row({name, hidden, symbol, quantity, reason, sample}: {name: string; hidden?: string; symbol: string; quantity: Quantity | null; reason?: string | undefined; sample?: JSX.Element | null}): JSX.Element {
  const written = quantity ? writeQuantity(quantity) : null;
  return <tr>
    <th scope="row">{sample}{name || <span class="visually-hidden">{hidden}</span>}</th><td class="nowrap">{symbol}</td>
    <td class="n">{written ? <b>{written.value}</b> : <b title={reason}>…</b>}</td>
    {written ? <><td class="ci">{written.interval}</td><td class="u nowrap">{writeUnit(quantity?.unit)}</td></> : <td class="u" colSpan={2}>{reason ? writeSentence(reason) : 'not identifiable'}</td>}
  </tr>;
}

// 1/β with its interval.
function inverse(beta: Quantity | null | undefined): Quantity | null {
  if (!beta || beta.value === null || beta.value <= 0) return null;
  const [low, high] = beta.ci95 ?? [];
  return {value: 1 / beta.value, unit: 's', ci95: [high ? 1 / high : null, low ? 1 / low : null]};
}

export function FittedModel({fit}: {fit: ModelFit}): JSX.Element {
  const seen = new Map<string, number>();
  return <Panel title="Fitted model" sub={`${fit.model}${fit.intervals ? `, ${fit.intervals} intervals` : ''}`}>
    <table class="params"><caption class="visually-hidden">Parameters of {fit.model} with 95 % intervals</caption><tbody>
      {fit.processes.flatMap((process, i) => {
        const nth = seen.get(process.process) ?? 0;
        seen.set(process.process, nth + 1);
        const style = styleOf(process.process, nth);
        const rows = Object.entries(process.params).map(([name, quantity], j) => <Row key={`${i}${name}`} name={j === 0 ? processName(process.process) : ''} hidden={processName(process.process)} symbol={symbolOf(name)} quantity={quantity} reason={process.reasons?.[name]}
          sample={j === 0 ? <svg width="30" height="10" aria-hidden="true"><line x1="0" x2="22" y1="6" y2="6" stroke={style.colour} stroke-width="1.6" stroke-dasharray={style.dash} /></svg> : null} />);
        const time = inverse(process.params.beta);
        return time ? [...rows, <Row key={`${i}time`} name="" hidden={processName(process.process)} symbol="1/β" quantity={time} />] : rows;
      })}
    </tbody></table>
    {fit.warnings.map(warning => <p key={warning} class="note"><span class="g warn" aria-hidden="true">△ </span>{warning}</p>)}
  </Panel>;
}

const LINEAR_TO = 6;
const symlog = (x: number): number => x <= LINEAR_TO ? x : LINEAR_TO * (1 + Math.log(x / LINEAR_TO));

export function Ranking({fits, chosen, onChoose}: {fits: readonly ModelFit[]; chosen: number; onChoose: (index: number) => void}): JSX.Element {
  const best = fits[0]?.wic ?? 0;
  const above = fits.map(fit => fit.wic === null ? null : fit.wic - best);
  const most = Math.max(LINEAR_TO, ...above.map(x => x ?? 0));
  const width = 250;
  const x = (value: number): number => 8 + symlog(value) / symlog(most) * (width - 74);
  const ticks = [0, 6, 30, 100, 300, 1000, 3000, 10000].filter(tick => tick <= most);
  const closest = fits.findIndex(fit => fit.closest ?? fit.plausible);
  const behind = fits[0]?.distance_2p;
  return <Panel title="Ranking" sub={`${fits.length} candidates`}>
    <div class="row u"><span style={{width: '142px'}}>model</span><span>criterion above the best</span></div>
    {fits.map((fit, i) => <button key={`${fit.model}${fit.robust}`} type="button" class="model-row" aria-pressed={i === chosen} onClick={() => onChoose(i)}>
      <span>{fit.model}<span class="visually-hidden">, {above[i] === null ? 'no criterion' : `${writeNumber(above[i])} above the best`}, {fit.plausible ? 'plausible' : 'ruled out'}{fit.distance_2p === undefined ? '' : `, ${writeNumber(fit.distance_2p)} further from the data than the closest`}{fit.status === 'collapsed' ? ', a component vanished' : ''}, J test {writeP(fit.j_test?.p)}</span></span><span class="u" aria-hidden="true">{fit.status === 'collapsed' ? '∅' : ''}</span>
      <svg viewBox={`0 0 ${width} 26`} width="100%" height="26" preserveAspectRatio="xMinYMid meet" aria-hidden="true">
        {ticks.map(tick => <line key={tick} class="gr" x1={x(tick)} x2={x(tick)} y1="0" y2="26" />)}
        {above[i] !== null && <circle cx={x(above[i]!)} cy="13" r="4" fill={fit.plausible ? 'var(--model)' : 'var(--surface)'} stroke={fit.plausible ? 'var(--model)' : 'var(--ink3)'} stroke-width="1.5" />}
        {above[i] !== null && <text x={x(above[i]!) + 10} y="17">{i === 0 ? 'best' : `+${writeNumber(above[i])}`}</text>}
      </svg>
    </button>)}
    <div class="model-row" aria-hidden="true"><span /><span /><svg viewBox={`0 0 ${width} 16`} width="100%" height="16" preserveAspectRatio="xMinYMid meet">{ticks.map(tick => <text key={tick} class="s" x={x(tick)} y="12" text-anchor="middle">{tick}</text>)}</svg></div>
    <p class="note">● plausible: the data cannot tell it from the best · ○ ruled out · ∅ a component vanished.<span class="no-print"> A click draws the model.</span></p>
    {closest > 0 && !fits[0]!.plausible && <p class="note">Ranked first by the criterion; {fits[closest]!.model} is closer to the data{behind ? `, by ${writeNumber(behind)} in distance + 2p, of which 6 are chance` : ''}.</p>}
  </Panel>;
}

export function Ieee({channel}: {channel: Channel}): JSX.Element {
  const found = (['N', 'B', 'K', 'Q', 'R'] as const).filter(name => channel.allan_parameters[name]);
  const absent = (['N', 'B', 'K', 'Q', 'R'] as const).filter(name => !channel.allan_parameters[name]);
  return <Panel title="Read off by IEEE Std 952">
    <table class="params"><tbody>
      {found.map(name => <Row key={name} name={name} symbol="" quantity={channel.allan_parameters[name]} />)}
      {absent.length > 0 && <tr><th scope="row">{absent.join(', ')}</th><td /><td class="n"><b>…</b></td><td class="u" colSpan={2}>
        <details><summary>not identified</summary>{absent.map(name => <div key={name}>{name}: {channel.allan_parameters.reasons[name] ?? 'not identifiable.'}</div>)}</details></td></tr>}
    </tbody></table>
  </Panel>;
}

export function OtherNames({channel}: {channel: Channel}): JSX.Element | null {
  const names = channel.equivalents?.N;
  if (!names || names.length === 0) return null;
  const text = names.map(one => `${conventionName(one.convention)}\t${one.value}\t${one.unit}`).join('\n');
  return <Panel title="N under its other names" tools={<div class="tools"><button type="button" class="quiet" onClick={() => copy(text, 'All names are')}>Copy all</button></div>}>
    <table class="params"><tbody>{names.map(one => <tr key={one.convention}><th scope="row">{conventionName(one.convention)}</th><td class="n"><b>{writeQuantity(one).value}</b></td><td class="u">{writeUnit(one.unit)}</td></tr>)}</tbody></table>
  </Panel>;
}

export function FilePanel({recording, result}: {recording: Recording; result?: Characterisation | undefined}): JSX.Element {
  const {file} = recording;
  return <Panel title="File" tools={<div class="tools"><a href={`/v1/recordings/${recording.id}`}>JSON</a></div>}>
    <table class="params"><tbody>
      {recording.metadata.id && <tr><th scope="row">name</th><td>{recording.metadata.id}</td></tr>}
      <tr><th scope="row">labels</th><td><LabelsOf recording={recording} /></td></tr>
      <tr><th scope="row">format</th><td>{file.format ?? '–'}{file.compression && file.compression !== 'none' ? `, ${file.compression}` : ''}{file.bytes ? `, ${writeBytes(file.bytes)}` : ''}</td></tr>
      {recording.metadata.stream && <tr><th scope="row">stream</th><td>{recording.metadata.stream}</td></tr>}
      {file.rows && <tr><th scope="row">rows</th><td>{writeCount(file.rows)}</td></tr>}
      {file.columns && <tr><th scope="row">columns</th><td><code>{file.columns.slice(0, 12).join(', ')}{file.columns.length > 12 ? ' …' : ''}</code></td></tr>}
      <tr><th scope="row">SHA-256</th><td><button type="button" class="link no-print" onClick={() => copy(file.sha256, 'The hash is')}><code>{file.sha256.slice(0, 16)}…</code></button><code class="print-only">{file.sha256}</code></td></tr>
      <tr><th scope="row">uploaded</th><td>{writeFull(recording.created_at)}, revision {recording.revision}</td></tr>
      {result && <tr><th scope="row">characterised</th><td>{writeFull(result.created_at)}, algorithm {result.algorithm_version}, seed {result.parameters.seed ?? 1}, <a href={`/jobs/${result.job}`}>job</a></td></tr>}
    </tbody></table>
  </Panel>;
}
