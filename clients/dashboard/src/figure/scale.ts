// Scales of figures: a value to its pixel and back, and the numbers that stand at an axis.
export interface Mapping { (value: number): number; invert(pixel: number): number }

// A domain of one value lies in the middle.
export function linear(low: number, high: number, from: number, to: number): Mapping {
  const perUnit = high === low ? 0 : (to - from) / (high - low);
  const start = high === low ? (from + to) / 2 : from;
  return Object.assign((value: number) => start + (value - low) * perUnit, {invert: (pixel: number) => perUnit === 0 ? low : low + (pixel - start) / perUnit});
}

export function logarithmic(low: number, high: number, from: number, to: number): Mapping {
  const of = linear(Math.log(low), Math.log(high), from, to);
  return Object.assign((value: number) => of(Math.log(value)), {invert: (pixel: number) => Math.exp(of.invert(pixel))});
}

// About `count` numbers, 1, 2 or 5 times a power of ten apart.
export function ticksBetween(low: number, high: number, count: number): number[] {
  const rough = (high - low) / count;
  const power = 10 ** Math.floor(Math.log10(rough));
  const over = rough / power;
  const step = power * (over >= Math.sqrt(50) ? 10 : over >= Math.sqrt(10) ? 5 : over >= Math.SQRT2 ? 2 : 1);
  if (!(step > 0)) return [low];
  const first = Math.ceil(low / step);
  return Array.from({length: Math.floor(high / step) - first + 1}, (_, i) => Number(((first + i) * step).toPrecision(12)));
}

// `digits` times each power of ten from `low` to `high`, a little beyond for the sake of rounding.
export function decadeTicks(low: number, high: number, digits: readonly number[]): number[] {
  const ticks: number[] = [];
  for (let e = Math.floor(Math.log10(low)); e <= Math.ceil(Math.log10(high)); ++e) ticks.push(...digits.map(digit => Number(`${digit}e${e}`)));
  return ticks.filter(tick => tick >= low * (1 - 1e-9) && tick <= high * (1 + 1e-9));
}
