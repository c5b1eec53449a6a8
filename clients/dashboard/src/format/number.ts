// How numbers are written (brief, section 6): the 95 % interval decides the digits.

export interface Quantity {
  value: number | null;
  unit: string;
  ci95?: readonly (number | null)[] | null;
}

const MINUS = '\u2212';
const THIN = '\u202f';
const SUPERSCRIPTS: Record<string, string> = {'-': '⁻', '0': '⁰', '1': '¹', '2': '²', '3': '³', '4': '⁴', '5': '⁵', '6': '⁶', '7': '⁷', '8': '⁸', '9': '⁹'};

const superscript = (n: number): string => [...String(n)].map(c => SUPERSCRIPTS[c] ?? c).join('');

// Groups of three from 10 000 on, a typographic minus.
function plain(value: number, decimals: number): string {
  const [whole = '', fraction] = Math.abs(value).toFixed(Math.min(Math.max(decimals, 0), 20)).split('.');
  const grouped = whole.length > 4 ? whole.replace(/\B(?=(\d{3})+$)/g, THIN) : whole;
  const negative = value < 0 && /[1-9]/.test(whole + (fraction ?? ''));
  return (negative ? MINUS : '') + grouped + (fraction ? `.${fraction}` : '');
}

// The power of ten of the last digit that an interval of half-width `half` lets stand.
export function lastDigit(half: number): number {
  const e = Math.floor(Math.log10(half));
  const first = Math.floor(half / 10 ** e + 1e-9);
  return first === 1 ? e - 1 : e;
}

function rounded(value: number, last: number): string {
  if (last >= 0) {
    const step = 10 ** last;
    return plain(Math.round(value / step) * step, 0);
  }
  return plain(value, -last);
}

// Values too small or too large to be read in full are written as 2.6 × 10⁻⁵; all of them with the same power.
function powerOf(values: number[], last: number): number {
  const largest = Math.max(...values.map(Math.abs));
  if (largest === 0) return 0;
  const e = Math.floor(Math.log10(largest));
  return e < -4 || last >= 7 ? e : 0;
}

export interface Written {
  value: string;
  interval: string;  // '[1.035, 1.042]', or empty without one
}

export function writeQuantity(quantity: Quantity): Written {
  const {value} = quantity;
  if (value === null || !Number.isFinite(value)) return {value: '…', interval: ''};
  const [low = null, high = null] = quantity.ci95 ?? [];
  if (low === null || high === null || !(high > low)) {
    const ends = low === null && high === null ? '' : `[${low === null ? '…' : writeNumber(low)}, ${high === null ? '…' : writeNumber(high)}]`;
    return {value: writeNumber(value), interval: ends};
  }
  const last = lastDigit((high - low) / 2);
  const power = powerOf([value, low, high], last);
  if (power !== 0) {
    const scale = 10 ** power;
    const part = (x: number): string => rounded(x / scale, last - power);
    return {value: `${part(value)} × 10${superscript(power)}`, interval: `[${part(low)}, ${part(high)}] × 10${superscript(power)}`};
  }
  return {value: rounded(value, last), interval: `[${rounded(low, last)}, ${rounded(high, last)}]`};
}

// Without an interval: three significant digits.
export function writeNumber(value: number | null | undefined, digits = 3): string {
  if (value === null || value === undefined || !Number.isFinite(value)) return '–';
  if (value === 0) return '0';
  const e = Math.floor(Math.log10(Math.abs(value)));
  if (e < -4 || e >= 7) return `${plain(value / 10 ** e, digits - 1)} × 10${superscript(e)}`;
  return rounded(value, Math.min(e - digits + 1, 0));
}

export const writeCount = (n: number): string => plain(n, 0);

// Axis ticks: short, without trailing zeros; powers from 10⁵ and below 10⁻³.
export function writeTick(value: number): string {
  if (value === 0) return '0';
  const e = Math.round(Math.log10(Math.abs(value)) * 1e9) / 1e9;
  if (Number.isInteger(e) && (e >= 5 || e < -3)) return `10${superscript(e)}`;
  if (Math.abs(value) < 1e-3 || Math.abs(value) >= 1e6) return writeNumber(value, 2);
  return plain(value, Math.max(0, Math.min(6, 3 - Math.floor(Math.log10(Math.abs(value)))))).replace(/(\.\d*?)0+$/, '$1').replace(/\.$/, '');
}

export function writeP(p: number | null | undefined): string {
  if (p === null || p === undefined) return 'p unknown';
  return p < 0.01 ? 'p < 0.01' : `p = ${p.toFixed(2)}`;
}

export const writeShare = (share: number): string => `${Math.round(share * 100)}${THIN}%`;

export function writeBytes(bytes: number): string {
  if (bytes < 1000) return `${bytes} B`;
  const steps: [number, string][] = [[1e9, 'GB'], [1e6, 'MB'], [1e3, 'kB']];
  const [size, name] = steps.find(([s]) => bytes >= s) ?? [1e3, 'kB'];
  return `${(bytes / size).toFixed(1)} ${name}`;
}
