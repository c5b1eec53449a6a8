// What the columns of a file mean: as the daemon would read them, unless a person says otherwise.
import type {JSX} from 'preact';
import type {Nullable} from '../../api/documents';
import {writeTick} from '../../format/number';
import {quantityName, writeSentence, writeUnit} from '../../format/words';
import {Panel, Refusal} from '../../shell/states';
import {change, pending, type Pending, type Role} from './pending';
import {rolesOf, type PreviewColumn, type PreviewDocument} from './preview';
import {UnitField} from './UnitField';

const QUANTITIES: readonly (readonly [string, string])[] = [['time', 'time'], ['angular_rate', 'angular rate'], ['specific_force', 'specific force'], ['temperature', 'temperature'], ['reference_angular_rate', 'reference rate'], ['reference_angle', 'reference angle'], ['magnetic_field', 'magnetic field']];
export const UNITS: Record<string, string[]> = {time: ['s', 'ms', 'us', 'ns'], angular_rate: ['deg/s', 'rad/s', 'deg/h', 'mrad/s'], specific_force: ['m/s^2', 'g', 'mg'], temperature: ['degC', 'K'], reference_angular_rate: ['deg/s', 'rad/s'], reference_angle: ['deg', 'rad'], magnetic_field: ['uT', 'T']};
const AXES = ['x', 'y', 'z'];
const MOST_COLUMNS = 64;
const EMPTY: Role = {quantity: '', axis: '', unit: ''};

function Course({values: all}: {values: Nullable}): JSX.Element | null {
  const values = all.filter((value): value is number => value !== null);
  if (values.length < 2) return null;
  const low = Math.min(...values);
  const high = Math.max(...values);
  const points = values.map((value, i) => `${(i / (values.length - 1) * 148 + 1).toFixed(1)},${(high > low ? 21 - (value - low) / (high - low) * 18 : 12).toFixed(1)}`);
  return <svg width="150" height="24" viewBox="0 0 150 24" aria-hidden="true"><polyline points={points.join(' ')} fill="none" stroke="var(--ink)" stroke-width="1" /></svg>;
}

const WHY: Record<PreviewColumn['from'], string> = {header: 'read from the header', number: 'no header: numbered', stated: 'you chose'};

function whyOf(column: PreviewColumn): string {
  if (column.quantity === 'unspecified') return 'nothing says what it is: analysed as it is';
  return column.quantity === null ? column.from === 'stated' ? 'left out: only chosen columns are read' : 'not read' : WHY[column.from];
}

function ColumnRow({each, column}: {each: Pending; column: PreviewColumn}): JSX.Element {
  const role = each.roles[column.name] ?? EMPTY;
  const set = (changes: Partial<Role>): void => {
    // As said by now: leaving one field and choosing in another come before the row is drawn again.
    const said = pending().find(one => one.key === each.key)?.roles ?? each.roles;
    const roles = {...said, [column.name]: {...(said[column.name] ?? EMPTY), ...changes}};
    if (!roles[column.name]!.quantity) delete roles[column.name];
    change(each.key, {roles});
  };
  const label = (what: string): string => `${what} of ${column.name}`;
  const axes = role.quantity && role.quantity !== 'time' && role.quantity !== 'temperature';
  const read = column.quantity === null ? 'left out' : column.quantity === 'unspecified' ? 'not said' : quantityName(column.quantity);
  return <tr>
    <th scope="row"><code>{column.name}</code></th>
    <td><select aria-label={label('Quantity')} value={role.quantity} onChange={event => { const quantity = event.currentTarget.value; const guessed = column.axis ?? /([xyz])(?:\W|_|$)/i.exec(column.name)?.[1]?.toLowerCase(); set({quantity, unit: quantity === column.quantity && column.unit ? column.unit : UNITS[quantity]?.[0] ?? '', axis: quantity && quantity !== 'time' && quantity !== 'temperature' ? role.axis || guessed || 'z' : ''}); }}><option value="">{role.quantity ? 'as the file says' : read}</option>{QUANTITIES.map(([value, text]) => <option key={value} value={value}>{text}</option>)}</select></td>
    <td>{axes ? <select aria-label={label('Axis')} value={role.axis} onChange={event => set({axis: event.currentTarget.value})}>{AXES.map(axis => <option key={axis}>{axis}</option>)}</select> : column.axis ?? '–'}</td>
    <td>{role.quantity ? <UnitField name={column.name} unit={role.unit} known={UNITS[role.quantity] ?? []} set={unit => set({unit})} /> : column.unit ? writeUnit(column.unit) : '–'}</td>
    <td class="n"><code>{column.first[0] ?? '–'}</code></td>
    <td class="desk-only"><Course values={column.course} /></td>
    <td class="sec">{whyOf(column)}</td>
  </tr>;
}

// What the readings say against what a person said, each with the button that puts it right.
function Doubts({each, seen}: {each: Pending; seen: PreviewDocument}): JSX.Element {
  const {condition_guess: guess, time_guess: time} = seen;
  const other = guess && guess.text !== each.condition && /^(static|constant_rate)/.test(each.condition);
  const doubt = (text: string, button?: JSX.Element): JSX.Element => <p key={text} class="note"><span class="g warn" aria-hidden="true">△ </span>{writeSentence(text)} {button}</p>;
  return <>
    {seen.problems.map(problem => <p key={problem.detail} class="note"><span class="g bad" aria-hidden="true">✗ </span>{writeSentence(problem.detail)}</p>)}
    {other && doubt(`${guess.because} The condition says ${each.condition === 'static' ? 'that it is at rest' : 'otherwise'}.`, <button type="button" class="link touch" onClick={() => change(each.key, {condition: guess.text})}>Say so</button>)}
    {time && doubt(`Column ${time.column} rises as a time in ${time.unit} does, at ${writeTick(Number(time.rate_hz.toPrecision(4)))} Hz.`, <button type="button" class="link touch" onClick={() => change(each.key, {roles: {...rolesOf(seen), ...each.roles, [time.column]: {quantity: 'time', axis: '', unit: time.unit}}})}>It is the time</button>)}
    {seen.hints.map(hint => doubt(hint))}
    {seen.notes.map(note => <p key={note} class="note">{writeSentence(note)}</p>)}
  </>;
}

// What a person said of columns, where it was refused and has to be put right: no file is read then.
const saidOf = (each: Pending): PreviewColumn[] => Object.entries(each.roles).map(([name, role]) => ({name, quantity: role.quantity, axis: role.axis || null, unit: role.unit || null, from: 'stated', first: [], course: []}));

export function Columns({each}: {each: Pending}): JSX.Element {
  const seen = each.look?.document;
  const columns = seen?.columns ?? (each.look?.problem ? saidOf(each) : []);
  return <Panel title={`What the columns of ${each.file.name} mean`} sub="change what is wrong; nothing is kept until you say so">
    {each.look?.problem ? <Refusal problem={each.look.problem} /> : !seen ? <p class="sec">Reading the beginning of the file.</p> : columns.length === 0 && seen.problems.length === 0 && <p class="sec">The columns of this format are read once all of the file is there.</p>}
    {columns.length > 0 && <div class="scroll"><table>
      <thead><tr><th scope="col">column</th><th scope="col">quantity</th><th scope="col">axis</th><th scope="col">unit</th><th scope="col" class="n">first value</th><th scope="col" class="desk-only">course</th><th scope="col">why</th></tr></thead>
      <tbody>{columns.slice(0, MOST_COLUMNS).map(column => <ColumnRow key={column.name} each={each} column={column} />)}</tbody>
    </table></div>}
    {seen && <Doubts each={each} seen={seen} />}
  </Panel>;
}
