// Units in which a figure may be shown. Factors are of SI; nothing else of an error model is computed here.

const SI: Record<string, number> = {
  'rad/s': 1, 'deg/s': Math.PI / 180, 'deg/h': Math.PI / 180 / 3600, 'mrad/s': 1e-3,
  'm/s^2': 1, 'g': 9.80665, 'mg': 9.80665e-3, 'ug': 9.80665e-6,
};
const CHOICES: string[][] = [['deg/h', 'deg/s', 'rad/s'], ['mg', 'm/s^2', 'ug']];

// The units for a channel; the first is that of the parameters.
export function unitsFor(channelUnit: string): string[] {
  const quantity = channelUnit.includes('s^2') || /g$/.test(channelUnit) ? 1 : 0;
  return SI[channelUnit] === undefined ? [channelUnit] : CHOICES[quantity] ?? [channelUnit];
}

export function factorBetween(from: string, to: string): number {
  if (from === to) return 1;
  const a = SI[from];
  const b = SI[to];
  return a === undefined || b === undefined ? 1 : a / b;
}
