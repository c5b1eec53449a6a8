// The round length that a map's scale bar shows: 1, 2 or 5 times a power of ten, at most `most` pixels at `scale` pixels a metre.
export function barLength(scale: number, most: number): number {
  const rough = most / scale;
  const power = 10 ** Math.floor(Math.log10(rough));
  return [5, 2, 1].map(digit => digit * power).find(length => length <= rough) ?? power;
}
