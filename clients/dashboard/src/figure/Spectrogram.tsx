// Power over time and frequency against what is expected, one pixel a cell.
import type {JSX} from 'preact';
import {useEffect, useRef} from 'preact/hooks';
import {writeTick} from '../format/number';
import {useWidth} from './Figure';

export interface Ratios { time_s: number[]; f_hz: number[]; log10_ratio: (number | null)[][] }

const MOST = 1;        // a tenfold excess or lack has the full colour
const HEIGHT = 220;
const LEFT = 58;

function rgb(name: string): [number, number, number] {
  const text = getComputedStyle(document.documentElement).getPropertyValue(name).trim();
  const [, r = '0', g = '0', b = '0'] = /^#(..)(..)(..)/.exec(text) ?? [];
  return [parseInt(r, 16), parseInt(g, 16), parseInt(b, 16)];
}

// One pixel a cell; the browser enlarges it without smoothing.
function paint(canvas: HTMLCanvasElement, spectrogram: Ratios): void {
  const {log10_ratio: rows, f_hz: bands} = spectrogram;
  canvas.width = rows.length;
  canvas.height = bands.length;
  const context = canvas.getContext('2d');
  if (!context) return;
  const image = context.createImageData(rows.length, bands.length);
  const [even, more, less] = [rgb('--surface'), rgb('--robust'), rgb('--model')];
  rows.forEach((row, x) => row.forEach((value, band) => {
    const share = Math.min(Math.abs(value ?? 0) / MOST, 1);
    const end = (value ?? 0) > 0 ? more : less;
    const at = 4 * ((bands.length - 1 - band) * rows.length + x);
    for (let i = 0; i < 3; ++i) image.data[at + i] = Math.round(even[i]! + (end[i]! - even[i]!) * share);
    image.data[at + 3] = 255;
  }));
  context.putImageData(image, 0, 0);
}

export function Spectrogram({spectrogram, name}: {spectrogram: Ratios; name: string}): JSX.Element {
  const [box, width] = useWidth();
  const canvas = useRef<HTMLCanvasElement>(null);
  useEffect(() => {
    const again = (): void => { if (canvas.current) paint(canvas.current, spectrogram); };
    again();
    const scheme = window.matchMedia('(prefers-color-scheme: dark)');
    scheme.addEventListener('change', again);
    return () => scheme.removeEventListener('change', again);
  }, [spectrogram, width > 0]);
  const {f_hz: f, time_s: t} = spectrogram;
  const low = Math.log10(f[0] ?? 1);
  const high = Math.log10(f[f.length - 1] ?? 10);
  const decades = Array.from({length: Math.max(0, Math.floor(high) - Math.ceil(low) + 1)}, (_, i) => Math.ceil(low) + i);
  const end = t[t.length - 1] ?? 1;
  const step = [1, 2, 5, 10].map(digit => digit * 10 ** Math.floor(Math.log10(end / 5))).find(each => end / each <= 6) ?? end;
  const ticks = Array.from({length: Math.floor(end / step) + 1}, (_, i) => i * step);
  const right = width - 12;
  return <div ref={box} class="spectrogram">
    {width > 0 && <>
      <canvas ref={canvas} role="img" aria-label={`${name}: time to the right to ${writeTick(Number(end.toPrecision(3)))} s, frequency upwards; orange is more than expected, blue less.`} />
      <svg width={width} height={HEIGHT + 40} viewBox={`0 0 ${width} ${HEIGHT + 40}`} aria-hidden="true">
        {decades.map(e => { const y = HEIGHT * (high - e) / (high - low || 1); return <text key={e} x={LEFT - 8} y={Math.max(y + 4, 10)} text-anchor="end">{writeTick(10 ** e)}</text>; })}
        {ticks.map(tick => <text key={tick} x={LEFT + (right - LEFT) * tick / end} y={HEIGHT + 16} text-anchor="middle">{writeTick(Number(tick.toPrecision(3)))}</text>)}
        <text class="t" x={right} y={HEIGHT + 34} text-anchor="end">time, s</text>
        <text class="t" x={0} y={HEIGHT + 34}>frequency, Hz</text>
      </svg>
    </>}
  </div>;
}

export function ratiosCsv({time_s, f_hz, log10_ratio}: Ratios): string {
  return `time_s,${f_hz.map(f => `${f} Hz`).join(',')}\n${log10_ratio.map((row, i) => `${time_s[i]},${row.map(value => value ?? '').join(',')}`).join('\n')}\n`;
}
