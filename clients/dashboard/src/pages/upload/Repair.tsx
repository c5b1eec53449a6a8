// The field that mends a refusal, beside its sentence.
import type {JSX} from 'preact';
import {useState} from 'preact/hooks';
import {quantityName, writeUnit} from '../../format/words';
import {UNITS} from './Columns';
import {change, type Pending} from './pending';
import {rolesOf} from './preview';

const GIVEN = ['angular_rate', 'specific_force', 'time', 'temperature'];

function UnitField({each, column, quantities}: {each: Pending; column: string; quantities: readonly string[]}): JSX.Element {
  const set = (value: string): void => {
    const [quantity = '', unit = ''] = value.split('|');
    const axis = quantity === 'time' || quantity === 'temperature' ? '' : /([xyz])(?:\W|_|$)/i.exec(column)?.[1]?.toLowerCase() ?? 'z';
    change(each.key, {roles: {...(each.look?.document ? rolesOf(each.look.document) : {}), ...each.roles, [column]: {quantity, axis, unit}}});
  };
  return <label class="row">unit <select aria-label={`Unit that repairs ${each.file.name}`} value="" onChange={event => set(event.currentTarget.value)}><option value="">choose</option>
    {quantities.map(quantity => <optgroup key={quantity} label={quantityName(quantity)}>{UNITS[quantity]!.map(unit => <option key={unit} value={`${quantity}|${unit}`}>{writeUnit(unit)}</option>)}</optgroup>)}</select></label>;
}

// Said once the field is left: a rate half typed would be looked at, and the field with its sentence be gone. What is typed
// is the field's own until then, for the row is drawn again whenever the daemon has read something.
function RateField({each}: {each: Pending}): JSX.Element {
  const [typed, setTyped] = useState(each.rate);
  return <label class="row">rate <input type="text" size={7} placeholder="Hz" aria-label={`Rate in Hz that repairs ${each.file.name}`} value={typed} onInput={event => setTyped(event.currentTarget.value)} onChange={event => change(each.key, {rate: event.currentTarget.value})} /></label>;
}

export function Repair({each, code, detail, fields}: {each: Pending; code: string; detail: string; fields: Record<string, unknown>}): JSX.Element | null {
  const column = typeof fields.column === 'string' ? fields.column : null;
  const time = /time column .*has no unit/i.test(detail) ? each.look?.document?.columns.find(one => one.quantity === 'time')?.name : undefined;
  return <>
    {column && /unit/.test(code) && <UnitField each={each} column={column} quantities={GIVEN} />}
    {time && <UnitField each={each} column={time} quantities={['time']} />}
    {/rate|sampling|time column/i.test(detail) && <RateField each={each} />}
  </>;
}
