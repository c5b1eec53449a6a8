// Names of the field, in print: what the API writes in ASCII and snake_case never reaches a page.
import {parameters, processes} from '../../../../schema/names.json';
import {writeCount} from './number';

const PROCESSES: Record<string, string> = processes;
const SYMBOLS: Record<string, string> = parameters;
const CONVENTIONS: Record<string, string> = {
  ieee_952: 'IEEE 952', density_two_sided: 'density, two-sided', density_one_sided: 'density, one-sided', kalibr_noise_density: 'Kalibr',
  kalibr_random_walk: 'Kalibr', per_sample: 'per sample', step_per_sample: 'step per sample',
};

export const capital = (text: string): string => text.charAt(0).toUpperCase() + text.slice(1);
// Whatever a snake_case name names; people's names as people write them.
export const spaced = (name: string): string => name.replace(/_/g, ' ').replace(/\bgauss markov\b/, 'Gauss-Markov');

export const processName = (name: string): string => PROCESSES[name] ?? spaced(name);
// frequency_hz -> frequency: its unit stands beside the values.
export const symbolOf = (parameter: string): string => SYMBOLS[parameter] ?? parameter.replace(/_(hz|s|deg)$/, '').replace(/_/g, ' ');
export const conventionName = (name: string): string => CONVENTIONS[name] ?? spaced(name);

// deg/sqrt(h) -> deg/√h, m/s^2 -> m/s²
export function writeUnit(unit: string | null | undefined): string {
  if (!unit || unit === '1') return '';
  return unit.replace(/sqrt\(([^)]*)\)/g, '√$1').replace(/\^2/g, '²').replace(/\^3/g, '³').replace(/\*/g, '·').replace(/\bug\b/g, 'µg');
}

export function sensorOf(quantity: string): string {
  return quantity === 'angular_rate' ? 'gyroscope' : quantity === 'specific_force' ? 'accelerometer' : spaced(quantity);
}

export const quantityName = (quantity: string): string => spaced(quantity);
export const jobKind = (kind: string): string => spaced(kind);

export interface Condition {
  kind: string;
  axis?: string;
  value?: number;
  unit?: string;
  direction?: string;
}

// As people say it: at rest is 'static'; rates and accelerations with their axis only where it is not the page's.
export function conditionName(condition: Condition | null | undefined, axis?: string | null): string {
  if (!condition) return '–';
  if (condition.kind === 'constant_rate' || condition.kind === 'constant_angular_acceleration') {
    const about = condition.axis && condition.axis !== axis ? ` about ${condition.axis}` : '';
    return `${String(condition.value).replace('-', '\u2212')} ${writeUnit(condition.unit)}${about}`;
  }
  if (condition.kind === 'six_position') return `${condition.axis} ${condition.direction}`;
  return spaced(condition.kind);
}

// The one-word form that the API takes in a query.
export function conditionText(condition: Condition): string {
  return [condition.kind, condition.axis, condition.value, condition.unit, condition.direction].filter(part => part !== undefined && part !== null).join(':');
}

// WN+2GM -> its processes in words
const MODEL_WORDS: Record<string, string> = {WN: 'white noise', GM: 'Gauss-Markov', RW: 'random walk', DR: 'drift', QN: 'quantization', FN: 'flicker noise'};
export function modelWords(model: string): string {
  return model.split('+').map(part => {
    const found = /^(\d*)([A-Z]+)$/.exec(part);
    if (!found) return part;
    const word = MODEL_WORDS[found[2] ?? ''] ?? part;
    return found[1] ? `${found[1]} × ${word}` : word;
  }).join(', ');
}

// A sentence of the API as it is printed: units and minus signs of the field.
export const writeSentence = (text: string): string => writeUnit(text).replace(/(^|[\s[(])-(?=\d)/g, '$1\u2212');

export const plural = (n: number, one: string, many = `${one}s`): string => `${writeCount(n)} ${n === 1 ? one : many}`;
const COUNTS = ['no', 'one', 'two', 'three', 'four', 'five', 'six', 'seven', 'eight', 'nine', 'ten', 'eleven', 'twelve'];
export const countWord = (n: number): string => COUNTS[n] ?? String(n);

export function listWords(words: string[]): string {
  if (words.length < 2) return words.join('');
  return `${words.slice(0, -1).join(', ')} and ${words[words.length - 1]}`;
}
