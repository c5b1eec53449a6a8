// What d3-scale needs of d3-interpolate, which also knows colours, dates, strings and transforms (build.mjs puts this in its place):
// figures interpolate numbers alone.
export const interpolateNumber = (a: number, b: number) => (t: number): number => a * (1 - t) + b * t;
export const interpolateRound = (a: number, b: number) => (t: number): number => Math.round(a * (1 - t) + b * t);
export {interpolateNumber as interpolate};
export const piecewise = undefined;  // of diverging scales, which no figure has
