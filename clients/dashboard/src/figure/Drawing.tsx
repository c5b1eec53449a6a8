// The drawing itself: axes, marks, notes and keys of a column of plots, as one SVG.
import type {ComponentChildren, JSX} from 'preact';
import {writeTick} from '../format/number';
import {type Area, type Layout} from './layout';
import {MarkAt} from './MarkAt';
import {Band, Bars, Curve, Points, Sample} from './marks';
import type {Note, Series} from './spec';

const half = (x: number): number => Math.round(x * 2) / 2;

function Axes({place}: {place: Area}): JSX.Element {
  const {plot, x, y, left, right, top, bottom} = place;
  const writeX = plot.x.write ?? writeTick;
  const writeY = plot.y.write ?? writeTick;
  return <g>
    {x.ticks.map(t => <line key={t} class="gr" x1={half(x(t))} x2={half(x(t))} y1={top} y2={bottom} />)}
    {y.ticks.map(t => <line key={t} class="gr" x1={left} x2={right} y1={half(y(t))} y2={half(y(t))} />)}
    {(plot.rules ?? []).map(value => <line key={value} class="ax" x1={left} x2={right} y1={half(y(value))} y2={half(y(value))} />)}
    {!plot.hideX && x.minor.map(t => <line key={t} class="ax" x1={half(x(t))} x2={half(x(t))} y1={bottom} y2={bottom - 4} />)}
    {y.minor.map(t => <line key={t} class="ax" x1={left} x2={left + 4} y1={half(y(t))} y2={half(y(t))} />)}
    <path class="ax" d={plot.hideX ? `M${left},${top}V${bottom}` : `M${left},${top}V${bottom}H${right}`} />
    {!plot.hideX && x.ticks.map(t => <text key={t} x={half(x(t))} y={bottom + 17} text-anchor="middle">{writeX(t)}</text>)}
    {y.ticks.map(t => <text key={t} x={left - 8} y={half(y(t)) + 4} text-anchor="end">{writeY(t)}</text>)}
    {plot.y.name && <text class="t" x={0} y={top - 14}>{plot.y.name}</text>}
    {!plot.hideX && plot.x.name && <text class="t" x={right} y={bottom + 36} text-anchor="end">{plot.x.name}</text>}
  </g>;
}

const LETTER = 6;
const LEAST_ZONE = 2;  // px: a single sample of a long recording is seen

function Zones({place}: {place: Area}): JSX.Element {
  const {plot, x, left, right, top, bottom} = place;
  const inside = (value: number): number => Math.min(Math.max(x(value), left), right);
  let written = -Infinity;  // up to where words stand above the plot
  return <g>{(plot.zones ?? []).filter(zone => x(zone.to) >= left && x(zone.from) <= right).map(zone => {
    const from = Math.round(inside(zone.from) * 10) / 10;
    const wide = Math.round(Math.max(inside(zone.to) - from, LEAST_ZONE) * 10) / 10;
    const key = `${zone.style}${zone.from}`;
    switch (zone.style) {
      case 'shade': return <rect key={key} x={from} width={wide} y={top} height={bottom - top} fill={zone.colour} stroke="none" />;
      case 'hatch': {
        const strokes = Array.from({length: Math.max(1, Math.min(Math.floor(wide / 4), 400))}, (_, i) => `M${Math.round((from + 1 + i * 4) * 10) / 10},${top}V${bottom}`);
        return <path key={key} d={strokes.join('')} stroke={zone.colour} stroke-width="1" stroke-dasharray="2 2" fill="none" />;
      }
      case 'top': return <rect key={key} x={from} width={wide} y={top - 5} height="4" fill={zone.colour} stroke="none" />;
      case 'foot': return <rect key={key} x={from} width={wide} y={bottom - 4} height="4" fill={zone.colour} stroke="none" />;
      case 'diamond': return <MarkAt key={key} mark="diamond" x={from + wide / 2} y={top - 3} colour={zone.colour} size={2.4} />;
      case 'edge': return <line key={key} x1={from} x2={from} y1={top} y2={bottom} stroke={zone.colour} stroke-width="1.2" stroke-dasharray="5 3" />;
      case 'mark': {
        const at = Math.round((from + wide / 2) * 10) / 10;
        const fits = zone.text !== undefined && at - 4 > written;
        if (fits) written = at + LETTER * zone.text!.length + 8;
        return <g key={key}><path d={`M${at - 4},${top - 6}h8l-4,7Z`} fill={zone.colour} stroke="none" />{fits && <text class="s h" x={at + 6} y={top + 1}>{zone.text}</text>}</g>;
      }
    }
  })}</g>;
}

const GUIDES_BEGIN = 16;
function guidesApart({plot, left, right}: Area): number {
  return Math.min(84, (right - left - GUIDES_BEGIN) / Math.max(plot.guides?.length ?? 0, 1));
}

// Slopes as short strokes near the lower left, where the data of an Allan deviation are not.
function Guides({place}: {place: Area}): JSX.Element {
  const {plot, left, bottom} = place;
  const guides = plot.guides ?? [];
  const apart = guidesApart(place);
  const length = Math.min(46, apart - 30);
  return <g>{guides.map((guide, i) => {
    const x = left + GUIDES_BEGIN + i * apart;
    const y = bottom - 30;
    const rise = guide.slope * length;
    return <g key={guide.text}>
      <line class="ax" x1={x} x2={x + length} y1={y + rise / 2} y2={y - rise / 2} />
      <text class="s h" x={x + length + 5} y={y + 4}>{guide.text}</text>
    </g>;
  })}</g>;
}

// How far the text of a note that drops to the axis is lifted, so that it lies neither on its neighbour nor on the guides.
const NOTE_WIDTH = 124;
const NOTE_LINES = 34;
const GUIDES_HEIGHT = 48;
function lifts(notes: readonly Note[], place: Area): Map<Note, number> {
  const lifted = new Map<Note, number>();
  const guides = place.plot.guides?.length ?? 0;
  const guidesEnd = guides > 0 ? place.left + GUIDES_BEGIN + guides * guidesApart(place) : -Infinity;
  let before = -Infinity;
  let level = 0;
  for (const note of notes.filter(each => each.drop).sort((a, b) => a.x - b.x)) {
    level = place.x(note.x) - before < NOTE_WIDTH ? level + 1 : 0;
    before = place.x(note.x);
    lifted.set(note, level * NOTE_LINES + (place.x(note.x) < guidesEnd ? GUIDES_HEIGHT : 0));
  }
  return lifted;
}

function NoteMark({note, place, lift}: {note: Note; place: Area; lift: number}): JSX.Element {
  const x = place.x(note.x);
  const y = place.y(note.y);
  const colour = note.colour ?? 'var(--ink)';
  const textX = note.drop ? x + 6 : note.line === undefined ? x : place.right;
  const textY = note.drop ? place.bottom - lift - (note.sub ? 22 : 8) : y - 10;
  const anchor = note.drop ? 'start' : note.line === undefined ? note.anchor ?? 'start' : 'end';
  return <g>
    {note.drop && <line x1={x} x2={x} y1={y} y2={place.bottom} stroke={colour} stroke-width="1" stroke-dasharray="1 2" />}
    {note.line !== undefined && <line x1={place.left + (place.right - place.left) * 0.62} x2={place.right} y1={place.y(note.line)} y2={place.y(note.line)} class="ax" />}
    {note.ring && <circle cx={x} cy={y} r="5.5" fill="none" stroke={colour} stroke-width="1.2" />}
    <text class="h t" x={textX} y={note.line === undefined ? textY : place.y(note.line) - (note.sub ? 17 : 6)} text-anchor={anchor} style={{fill: colour}}>{note.text}</text>
    {note.sub && <text class="s h" x={textX} y={note.line === undefined ? textY + 14 : place.y(note.line) - 4} text-anchor={anchor}>{note.sub}</text>}
  </g>;
}

function Keys({plan}: {plan: Layout}): JSX.Element {
  const {areas, keyBelow, keyLeft, keyWidth, width} = plan;
  const last = areas[areas.length - 1];
  const columns = Math.max(1, Math.floor(width / keyWidth));
  let count = 0;
  return <g>{areas.map(place => {
    let y = place.top + 12;
    return place.plot.series.filter(series => !series.hidden && !series.noKey).map(series => {
      const index = count++;
      const sampleX = keyBelow ? (index % columns) * keyWidth : keyLeft;
      const sampleY = keyBelow ? (last?.foot ?? 0) + 12 + Math.floor(index / columns) * 18 : y;
      y += series.detail ? 40 : 26;
      return <g key={series.id}>
        <Sample series={series} x={sampleX} y={sampleY} />
        <text class="t" x={sampleX + 30} y={sampleY + 4}>{series.name}</text>
        {series.detail && !keyBelow && <text class="s" x={sampleX + 30} y={sampleY + 18}>{series.detail}</text>}
      </g>;
    });
  })}</g>;
}

// The first series of the key lies on top.
const drawn = (place: Area): Series[] => place.plot.series.filter(series => !series.hidden).reverse();

export interface DrawingProps {
  plan: Layout;
  id: string;
  cursor: ComponentChildren;
}

export function Drawing({plan, id, cursor}: DrawingProps): JSX.Element {
  return <>
    {plan.areas.map(place => { const lifted = lifts(place.plot.notes ?? [], place); return <g key={place.plot.id}>
      <clipPath id={`${id}-${place.plot.id}`}><rect x={place.left} y={place.top - 6} width={place.right - place.left + 6} height={place.bottom - place.top + 6} /></clipPath>
      <Axes place={place} />
      <Zones place={place} />
      <Guides place={place} />
      <g clip-path={`url(#${id}-${place.plot.id})`}>
        {drawn(place).map(series => <Bars key={series.id} series={series} place={place} />)}
        {drawn(place).map(series => <Band key={series.id} series={series} place={place} />)}
        {drawn(place).map(series => <Curve key={series.id} series={series} place={place} />)}
        {drawn(place).map(series => <Points key={series.id} series={series} place={place} />)}
      </g>
      {(place.plot.notes ?? []).map(note => <NoteMark key={note.text} note={note} place={place} lift={lifted.get(note) ?? 0} />)}
    </g>; })}
    <Keys plan={plan} />
    {cursor}
  </>;
}
