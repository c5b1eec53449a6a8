// What the columns of a file mean: as the daemon would read them, unless a person says otherwise.
import type {JSX} from 'preact';
import {Panel} from '../../shell/states';
import type {Column} from './look';
import {change, type Pending, type Role} from './pending';

const QUANTITIES: readonly (readonly [string, string])[] = [['', 'as the header says'], ['time', 'time'], ['angular_rate', 'angular rate'], ['specific_force', 'specific force'], ['temperature', 'temperature'], ['reference_angular_rate', 'reference rate'], ['reference_angle', 'reference angle'], ['magnetic_field', 'magnetic field']];
const UNITS: Record<string, string[]> = {time: ['s', 'ms', 'us', 'ns'], angular_rate: ['deg/s', 'rad/s', 'deg/h', 'mrad/s'], specific_force: ['m/s^2', 'g', 'mg'], temperature: ['degC', 'K'], reference_angular_rate: ['deg/s', 'rad/s'], reference_angle: ['deg', 'rad'], magnetic_field: ['uT', 'T']};
const AXES = ['x', 'y', 'z'];
const EMPTY: Role = {quantity: '', axis: '', unit: ''};

function Course({values}: {values: number[]}): JSX.Element | null {
  if (values.length < 2) return null;
  const low = Math.min(...values);
  const high = Math.max(...values);
  const points = values.map((value, i) => `${(i / (values.length - 1) * 148 + 1).toFixed(1)},${(high > low ? 21 - (value - low) / (high - low) * 18 : 12).toFixed(1)}`);
  return <svg width="150" height="24" viewBox="0 0 150 24" aria-hidden="true"><polyline points={points.join(' ')} fill="none" stroke="var(--ink)" stroke-width="1" /></svg>;
}

function ColumnRow({each, column}: {each: Pending; column: Column}): JSX.Element {
  const role = each.roles[column.name] ?? EMPTY;
  const set = (changes: Partial<Role>): void => {
    const roles = {...each.roles, [column.name]: {...role, ...changes}};
    if (!roles[column.name]!.quantity) delete roles[column.name];
    change(each.key, {roles});
  };
  const label = (what: string): string => `${what} of ${column.name}`;
  const axes = role.quantity && role.quantity !== 'time' && role.quantity !== 'temperature';
  return <tr>
    <th scope="row"><code>{column.name}</code></th>
    <td><select aria-label={label('Quantity')} value={role.quantity} onChange={event => { const quantity = event.currentTarget.value; const guessed = /([xyz])(?:\W|_|$)/i.exec(column.name)?.[1]?.toLowerCase(); set({quantity, unit: UNITS[quantity]?.[0] ?? '', axis: quantity && quantity !== 'time' && quantity !== 'temperature' ? role.axis || guessed || 'z' : ''}); }}>{QUANTITIES.map(([value, text]) => <option key={value} value={value}>{text}</option>)}</select></td>
    <td>{axes ? <select aria-label={label('Axis')} value={role.axis} onChange={event => set({axis: event.currentTarget.value})}>{AXES.map(axis => <option key={axis}>{axis}</option>)}</select> : '–'}</td>
    <td>{role.quantity ? <select aria-label={label('Unit')} value={role.unit} onChange={event => set({unit: event.currentTarget.value})}>{(UNITS[role.quantity] ?? []).map(unit => <option key={unit}>{unit}</option>)}</select> : '–'}</td>
    <td class="n"><code>{column.first || '–'}</code></td>
    <td class="desk-only"><Course values={column.course} /></td>
    <td class="sec">{role.quantity ? 'you chose' : Object.keys(each.roles).length > 0 ? 'left out: only chosen columns are read' : each.look?.reason}</td>
  </tr>;
}

export function Columns({each}: {each: Pending}): JSX.Element {
  const columns = each.look?.columns ?? [];
  return <Panel title={`What the columns of ${each.file.name} mean`} sub="change what is wrong; nothing is uploaded until you say so">
    {columns.length === 0 ? <p class="sec">{each.look ? `Nothing to choose: ${each.look.reason}.` : 'Reading the beginning of the file.'}</p> : <div class="scroll"><table>
      <thead><tr><th scope="col">column</th><th scope="col">quantity</th><th scope="col">axis</th><th scope="col">unit</th><th scope="col" class="n">first value</th><th scope="col" class="desk-only">course</th><th scope="col">why</th></tr></thead>
      <tbody>{columns.map(column => <ColumnRow key={column.name} each={each} column={column} />)}</tbody>
    </table></div>}
  </Panel>;
}
