// What d3-scale imports of d3-format (build.mjs puts this in its place): only `tickFormat` of a scale needs it, and figures write
// their ticks as the house writes numbers (writeTick).
export const format = undefined, formatPrefix = undefined, formatSpecifier = undefined;
export const precisionFixed = undefined, precisionPrefix = undefined, precisionRound = undefined;
