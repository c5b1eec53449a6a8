// Intervals of what two independent estimates say together, from the 95 % interval of each: the distances of the ends are added in
// squares, each on its own side (Zou and Donner 2008, Statistics in Medicine 27, 1693, "MOVER").
import type {Quantity} from './number';

export type Interval = readonly [number, number];

interface Known { value: number; low: number; high: number }

// Nothing for an estimate whose interval is open: what is made of it has none either.
export function known({value, ci95}: Pick<Quantity, 'value' | 'ci95'>): Known | null {
  const [low, high] = ci95 ?? [];
  const ends = [value, low, high];
  return ends.every(each => typeof each === 'number' && Number.isFinite(each)) ? {value: value!, low: low!, high: high!} : null;
}

// Of a - b.
export function difference(a: Known, b: Known): Interval {
  const d = a.value - b.value;
  return [d - Math.hypot(a.value - a.low, b.high - b.value), d + Math.hypot(a.high - a.value, b.value - b.low)];
}

const logarithm = ({value, low, high}: Known): Known | null => low > 0 && value > 0 ? {value: Math.log(value), low: Math.log(low), high: Math.log(high)} : null;

// Of a / b, on the logarithms; nothing where an end is not positive.
export function ratio(a: Known, b: Known): Interval | null {
  const [over, under] = [logarithm(a), logarithm(b)];
  if (!over || !under) return null;
  const [low, high] = difference(over, under);
  return [Math.exp(low), Math.exp(high)];
}
