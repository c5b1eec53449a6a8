// A figure as a file of its own: light palette, fonts named, its source under it.
import type {Plot} from './spec';

const TEXT_STYLES = `text{font:12px Inter,Helvetica,Arial,sans-serif;fill:#4a5056}text.t{fill:#16191d}text.s{font-size:11px;fill:#666c73}text.b{font-weight:600;fill:#16191d}text.h{paint-order:stroke;stroke:#fff;stroke-width:3px;stroke-linejoin:round}.gr{stroke:#e2e2dc;fill:none}.ax{stroke:#82878d;fill:none}`;

function inLight(text: string): string {
  const probe = document.createElement('div');
  probe.className = 'light';
  document.body.append(probe);
  const styles = getComputedStyle(probe);
  const coloured = text.replace(/var\((--[\w-]+)\)/g, (_, name: string) => styles.getPropertyValue(name).trim() || '#000');
  probe.remove();
  return coloured;
}

const SVG = 'http://www.w3.org/2000/svg';
const FOOT = 20;
const BESIDE = 16;

function make(name: string, text: string, attributes: Record<string, string | number> = {}): SVGElement {
  const element = document.createElementNS(SVG, name);
  element.textContent = text;
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, String(value));
  return element;
}

declare const DRIFTLAB_VERSION: string;

// 'driftlab, rec_…, seed 1' with the version: 'driftlab 0.1.0, rec_…, seed 1'.
export const versioned = (source: string): string => source.replace(/^driftlab\b/, `driftlab ${DRIFTLAB_VERSION}`);

// One drawing as a file, or several side by side.
export function svgText(drawings: readonly SVGSVGElement[], title: string, source: string): string {
  const file = make('svg', '', {role: 'img'});
  let width = 0;
  let height = 0;
  for (const drawing of drawings) {
    const {x, y, width: wide, height: high} = drawing.viewBox.baseVal;
    const copy = drawing.cloneNode(true) as SVGSVGElement;
    for (const gone of [...copy.querySelectorAll('[data-cursor]')]) gone.remove();
    copy.querySelector('title')?.remove();
    const left = width === 0 ? 0 : width + BESIDE;
    const part = make('g', '', left - x === 0 && y === 0 ? {} : {transform: `translate(${left - x} ${-y})`});
    part.append(...copy.childNodes);
    file.append(part);
    width = left + wide;
    height = Math.max(height, high);
  }
  for (const [key, value] of Object.entries({viewBox: `0 0 ${width} ${height + FOOT}`, width, height: height + FOOT})) file.setAttribute(key, String(value));
  file.prepend(make('title', title), make('style', TEXT_STYLES), make('rect', '', {width, height: height + FOOT, fill: '#ffffff'}));
  file.append(make('text', versioned(source), {class: 's', x: 0, y: height + FOOT - 6}));
  return inLight(new XMLSerializer().serializeToString(file));
}

export interface Table { heading: string[]; rows: (string | number | null)[][] }

// Every series as columns over the x they share; full precision.
export function tableOf(plots: readonly Plot[]): Table {
  const first = plots[0];
  if (!first) return {heading: [], rows: []};
  const series = plots.flatMap(plot => plot.series.map(one => ({one, unit: plot.y.name})));
  const measured = series.filter(({one}) => one.mark);
  const grid = new Set<number>();
  for (const {one} of measured.length > 0 ? measured : series) for (const x of one.x) grid.add(x);
  const xs = [...grid].sort((a, b) => a - b);
  const heading = [plots.find(plot => plot.x.name)?.x.name ?? ''];  // of plots that share it only the last says it
  const columns: (number | null)[][] = [];
  for (const {one, unit} of series) {
    const index = new Map(one.x.map((x, i) => [x, i] as const));
    const pick = (values: readonly (number | null)[]): (number | null)[] => xs.map(x => { const i = index.get(x); return i === undefined ? null : values[i] ?? null; });
    if (!xs.some(x => index.has(x))) continue;
    heading.push(`${one.name} (${unit || 'same unit'})`);
    columns.push(pick(one.y));
    if (one.low && one.high) {
      heading.push(`${one.name}, 95 % low`, `${one.name}, 95 % high`);
      columns.push(pick(one.low), pick(one.high));
    }
  }
  return {heading, rows: xs.map((x, i) => [x, ...columns.map(column => column[i] ?? null)])};
}

const field = (value: string | number | null): string => {
  const text = value === null ? '' : String(value);
  return /[",\n\r]/.test(text) ? `"${text.replace(/"/g, '""')}"` : text;
};

export const csvOf = (table: Table): string => [table.heading, ...table.rows].map(row => row.map(field).join(',')).join('\n') + '\n';

export function save(name: string, type: string, text: string): void {
  const url = URL.createObjectURL(new Blob([text], {type}));
  const link = document.createElement('a');
  link.href = url;
  link.download = name;
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(url), 10000);
}
