import type {JSX} from 'preact';

const KINDS: readonly (readonly [string, string])[] = [['static', 'static'], ['constant_rate', 'constant rate'], ['constant_angular_acceleration', 'angular acceleration'], ['profile', 'motion with reference'], ['drive', 'drive']];
const UNITS: Record<string, string> = {constant_rate: 'deg/s', constant_angular_acceleration: 'deg/s^2'};

// The condition in the one-word form of the API, as fields.
export function ConditionField({label, value, onChange}: {label: string; value: string; onChange: (value: string) => void}): JSX.Element {
  const [kind = 'static', axis = 'z', amount = ''] = value.split(':');
  const unit = UNITS[kind];
  const write = (next: {kind?: string; axis?: string; amount?: string}): void => {
    const k = next.kind ?? kind;
    onChange(UNITS[k] ? `${k}:${next.axis ?? (axis || 'z')}:${next.amount ?? amount}:${UNITS[k]}` : k);
  };
  return <span class="row">
    <select aria-label={label} value={kind} onChange={event => write({kind: event.currentTarget.value, amount: amount || '10'})}>{KINDS.map(([key, text]) => <option key={key} value={key}>{text}</option>)}</select>
    {unit && <><select aria-label={`${label}: axis`} value={axis} onChange={event => write({axis: event.currentTarget.value})}>{['x', 'y', 'z'].map(each => <option key={each}>{each}</option>)}</select>
      <input type="text" size={5} aria-label={`${label}: ${unit}`} value={amount} onInput={event => write({amount: event.currentTarget.value})} /> <span class="u">{unit.replace('^2', '²')}</span></>}
  </span>;
}
