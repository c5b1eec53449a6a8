// The parameter table as a figure: value, arrow, interval, and a dot with whisker on the axis of its column.
import type {JSX} from 'preact';
import {writeP, writeQuantity, writeTick} from '../../format/number';
import type {Quantity} from '../../api/documents';
import {conditionName, conditionText, plural, writeUnit} from '../../format/words';
import {decadeTicks, logarithmic} from '../../figure/scale';
import {choose, usePlace} from '../../route';
import {Segments} from '../../shell/states';
import {colours, columnName, uniqueName, withDensity, type Cell, type ParameterTable, type TableRow} from './documents';

const WIDTH = 88;
const ARROWS: Record<string, string> = {up: '↑', down: '↓'};
const CHANGES: Record<string, string> = {up: 'rose', down: 'fell', none: 'no change shown'};

interface Scale { (value: number): number; ticks: number[] }

function scaleOf(table: ParameterTable, key: string): Scale | null {
  const values = table.rows.flatMap(row => { const cell = row.values[key]; return cell ? [cell.value, ...cell.ci95] : []; }).filter((x): x is number => x !== null && x > 0);
  if (values.length === 0) return null;
  const low = Math.min(...values) / 1.15;
  const high = Math.max(...values) * 1.15;
  const at = logarithmic(low, high, 6, WIDTH - 6);
  const x = (value: number): number => Math.min(Math.max(at(value), 0), WIDTH);
  const all = decadeTicks(low, high, [1, 2, 5]);
  const ticks = all.filter((tick, i) => i === 0 || x(tick) - x(all[i - 1]!) > 26 || all.length < 4);
  return Object.assign(x, {ticks: ticks.length > 4 ? ticks.filter(tick => /^1/.test(tick.toExponential())) : ticks});
}

function Micro({cell, reference, scale, colour}: {cell: Cell | null; reference: Cell | null | undefined; scale: Scale | null; colour: string}): JSX.Element {
  return <svg width={WIDTH} height="46" viewBox={`0 0 ${WIDTH} 46`} aria-hidden="true">
    {scale && reference && <line x1={scale(reference.value)} x2={scale(reference.value)} y1="0" y2="46" stroke="var(--rule)" stroke-dasharray="1 2" />}
    {scale && cell && cell.value > 0 && <>
      {cell.ci95[0] !== null && cell.ci95[1] !== null && <line x1={scale(Math.max(cell.ci95[0]!, 1e-300))} x2={scale(cell.ci95[1]!)} y1="23" y2="23" stroke={colour} stroke-width="1.6" />}
      <circle cx={scale(cell.value)} cy="23" r="4" fill={colour} />
    </>}
  </svg>;
}

const ABSENT = {none_found: 'none found', not_identifiable: 'not identifiable'};

// How many times the value of the reference row, with its interval.
function ratioWords(ratio: Quantity | null): string {
  if (!ratio || ratio.value === null) return '';
  const written = writeQuantity(ratio);
  return `${written.value} times${written.interval ? ` ${written.interval}` : ''}`;
}

function Value({cell, reason, why, against}: {cell: Cell | null; reason?: string | undefined; why?: keyof typeof ABSENT | undefined; against: string}): JSX.Element {
  if (!cell) return <div class="pc" title={reason}><span class="v">…</span><span class="ar" /><span class="ci">{ABSENT[why ?? 'not_identifiable']}<span class="visually-hidden">. {reason}</span></span></div>;
  const written = writeQuantity(cell);
  const ratio = ratioWords(cell.ratio);
  return <div class="pc" title={ratio && `${ratio} that of ${against}`}><span class="v">{written.value}</span><span class="ar" aria-hidden="true">{cell.change ? ARROWS[cell.change] : ''}</span><span class="ci">{written.interval}<span class="visually-hidden"> {writeUnit(cell.unit)}{cell.change ? `, ${CHANGES[cell.change]} against ${against}` : ''}{ratio && `, ${ratio}`}</span></span></div>;
}

function RowHead({row, axis, colour, isReference, onReference, chosen, onChoose}: {row: TableRow; axis: string | null; colour: string; isReference: boolean; onReference: () => void; chosen: boolean; onChoose: (add: boolean) => void}): JSX.Element {
  const words = [plural(row.recordings.length, 'recording'), row.pooling && row.pooling !== 'single' ? row.pooling : '', row.agreement && row.agreement.p !== null ? `agree ${writeP(row.agreement.p)}` : ''].filter(Boolean).join(', ');
  return <th scope="row">
    <span class="key"><svg width="12" height="12" aria-hidden="true"><circle cx="6" cy="6" r="5" fill={colour} /></svg>
      <button type="button" class="link" aria-pressed={chosen} onClick={event => onChoose(event.shiftKey)}><b>{conditionName(row.condition, axis)}</b></button>
      {isReference ? <span class="u">reference row</span> : <button type="button" class="quiet u no-print" onClick={onReference}>reference</button>}</span>
    <div class="u" style={{marginLeft: '18px'}}>{row.fits === false ? <><span class="g warn" aria-hidden="true">△ </span>does not fit, J test {writeP(row.j_test_p ?? 0)}</> : row.contamination === 'contaminated' ? <><span class="g warn" aria-hidden="true">△ </span>gross errors{row.robust ? ', robust values' : ''}</> : words}</div>
  </th>;
}

export function Parameters({table: given}: {table: ParameterTable}): JSX.Element {
  const table = withDensity(given);
  const {query} = usePlace();
  const phoneColumn = Math.max(0, table.columns.findIndex(column => column.key === query.get('param')));
  const reference = Math.max(0, table.rows.findIndex(row => conditionText(row.condition) === table.reference));
  const colour = colours(table.rows);
  const scales = table.columns.map(column => scaleOf(table, column.key));
  const chosen = (query.get('sel') ?? '').split('|').filter(Boolean);
  const pick = (label: string, add: boolean): void => {
    const next = chosen.includes(label) ? chosen.filter(each => each !== label) : add ? [...chosen, label] : [label];
    choose({sel: next.join('|') || null});
  };
  const referenceLabel = conditionName(table.rows[reference]?.condition, table.axis);
  const against = (key: string): Cell | null => table.rows[reference]?.values[key] ?? null;
  const phone = table.columns[phoneColumn];
  return <>
    <div class="scroll desk-only"><table class="pt" style={{'--columns': String(table.columns.length)}}>
      <thead><tr><th scope="col">condition</th>{table.columns.map(column => { const name = columnName(column.key); return <th key={column.key} scope="colgroup" colSpan={2}>{name.process} <b>{name.symbol}</b> <span class="u">{writeUnit(column.unit)}</span></th>; })}</tr></thead>
      <tbody>{table.rows.map((row, i) => <tr key={row.label} class={i === reference ? 'ref' : ''}>
        <RowHead row={row} axis={table.axis} colour={colour[i]!} isReference={i === reference} onReference={() => choose({ref: i === 0 ? null : conditionText(row.condition)})} chosen={chosen.includes(row.label)} onChoose={add => pick(row.label, add)} />
        {table.columns.map((column, c) => { const cell = row.values[column.key] ?? null; return <>
          <td key={`${column.key}v`} class="num"><Value cell={cell} reason={row.reasons[column.key]} why={row.why[column.key]} against={referenceLabel} /></td>
          <td key={`${column.key}m`} class="mic"><Micro cell={cell} reference={against(column.key)} scale={scales[c] ?? null} colour={colour[i]!} /></td>
        </>; })}
      </tr>)}
      <tr class="axis" aria-hidden="true"><td />{table.columns.map((column, c) => <><td key={`${column.key}a`} /><td key={`${column.key}b`} class="mic"><svg width={WIDTH} height="22" viewBox={`0 0 ${WIDTH} 22`}><line class="ax" x1="0" x2={WIDTH} y1="0.5" y2="0.5" />{scales[c]?.ticks.map(tick => <text key={tick} class="s" x={scales[c]!(tick)} y="15" text-anchor="middle">{writeTick(tick)}</text>)}</svg></td></>)}</tr>
      </tbody>
    </table></div>
    <div class="phone-only">
      <Segments label="Parameter" options={table.columns.map((column, i) => [String(i), uniqueName(column.key, table.columns)] as const)} value={String(phoneColumn)} onChange={value => choose({param: value === '0' ? null : table.columns[Number(value)]!.key})} />
      {phone && <><p class="sec">{columnName(phone.key).process}, {writeUnit(phone.unit)}</p><ul class="pl">{table.rows.map((row, i) => { const cell = row.values[phone.key] ?? null; return <li key={row.label}><b>{conditionName(row.condition, table.axis)}</b><Micro cell={cell} reference={against(phone.key)} scale={scales[phoneColumn] ?? null} colour={colour[i]!} /><Value cell={cell} reason={row.reasons[phone.key]} why={row.why[phone.key]} against={referenceLabel} /></li>; })}</ul></>}
    </div>
    <p class="note">Value and 95 % interval; the interval decides the digits. ↑ ↓ changed against the reference row at 5 %. … the data do not identify it. Dotted line: the reference row. Axes logarithmic.</p>
  </>;
}
