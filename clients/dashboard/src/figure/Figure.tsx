// A figure on the page: heading and tools, the readout line, the drawing with its cursor, and the same as a table.
import type {ComponentChildren, JSX} from 'preact';
import {useEffect, useId, useLayoutEffect, useMemo, useRef, useState} from 'preact/hooks';
import {writeNumber} from '../format/number';
import {copy} from '../shell/copy';
import {openDrawer} from '../shell/Drawer';
import {Drawing} from './Drawing';
import {csvOf, save, svgText, tableOf, type Table} from './export';
import {layout} from './layout';
import {finite, nearest, valueAt, type Plot, type Series} from './spec';

export interface FigureProps {
  name: string;                 // of the files it is saved as
  title: string;
  sub?: ComponentChildren;
  controls?: ComponentChildren;
  describe: string;             // one sentence
  plots: readonly Plot[];
  source: string;               // 'driftlab 0.1.0, rec_…, algorithm 6, seed 1'
  curl?: string;
  how?: () => JSX.Element;
  cursor?: number | null;       // on the x axis of the plots
  onCursor?: (x: number | null, pinned: boolean) => void;
  readout?: (x: number) => ComponentChildren;
  quietReadout?: ComponentChildren;
  note?: ComponentChildren;
  onZoom?: (from: number, to: number) => void;
  plain?: boolean;              // without a panel of its own
}

export function useWidth(): [{current: HTMLDivElement | null}, number] {
  const box = useRef<HTMLDivElement>(null);
  const [width, setWidth] = useState(0);
  useLayoutEffect(() => {
    const element = box.current;
    if (!element) return undefined;
    const measure = (): void => setWidth(Math.floor(element.clientWidth));
    measure();
    const observer = new ResizeObserver(measure);
    observer.observe(element);
    return () => observer.disconnect();
  }, []);
  return [box, width];
}

export function TableView({table}: {table: Table}): JSX.Element {
  return <div class="table-view" tabIndex={0} role="region" aria-label="Values of the figure">
    <table>
      <thead><tr>{table.heading.map(text => <th key={text} scope="col">{text}</th>)}</tr></thead>
      <tbody>{table.rows.map((row, i) => <tr key={i}>{row.map((cell, j) => <td key={j}>{typeof cell === 'number' ? writeNumber(cell, 5) : cell ?? '…'}</td>)}</tr>)}</tbody>
    </table>
  </div>;
}

export interface ToolsProps {
  onTable?: (() => void) | undefined;
  tableShown?: boolean | undefined;
  onSvg?: (() => void) | undefined;
  onCsv?: (() => void) | undefined;
  curl?: string | undefined;
  how?: (() => JSX.Element) | undefined;
  title: string;
}

export function Tools({onTable, tableShown, onSvg, onCsv, curl, how, title}: ToolsProps): JSX.Element {
  const [isOpen, setOpen] = useState(false);
  return <><div class={`tools folds${isOpen ? ' open' : ''}`}>
    <button type="button" class="quiet more" aria-label={`Tools of ${title}`} aria-expanded={isOpen} onClick={() => setOpen(!isOpen)}>⋯</button>
    {onTable && <button type="button" class="quiet" aria-pressed={tableShown ?? false} onClick={onTable}>Table</button>}
    {onSvg && <button type="button" class="quiet" onClick={onSvg}>SVG</button>}
    {onCsv && <button type="button" class="quiet" onClick={onCsv}>CSV</button>}
    {curl && <button type="button" class="quiet" onClick={() => copy(curl, 'The command is')}>curl</button>}
    {how && <button type="button" class="quiet" onClick={() => openDrawer(`${title}: how it is computed`, how)}>How computed</button>}
  </div>{how && <div class="print-only method"><h3>How computed</h3>{how()}</div>}</>;
}

// The x that the cursor snaps to: those of the points, or of the first curve.
function snapping(plots: readonly Plot[]): readonly number[] {
  const all = plots.flatMap(plot => plot.series.filter(series => !series.hidden));
  return (all.find(series => series.mark) ?? all[0])?.x ?? [];
}

function valuesAt(plot: Plot, x: number): {series: Series; value: number | null; low: number | null; high: number | null}[] {
  const log = plot.x.scale === 'log';
  return plot.series.filter(series => !series.hidden).map(series => {
    if (!series.mark) return {series, value: valueAt(series, x, log && plot.y.scale === 'log'), low: null, high: null};
    const i = nearest(series.x, x, log);
    const near = i >= 0 && Math.abs(series.x[i]! - x) <= 1e-6 * Math.abs(x);
    return {series, value: near ? series.y[i] ?? null : null, low: near ? series.low?.[i] ?? null : null, high: near ? series.high?.[i] ?? null : null};
  });
}

export function defaultReadout(plot: Plot, x: number): JSX.Element {
  return <>{valuesAt(plot, x).filter(({value}) => finite(value)).map(({series, value, low, high}) =>
    <span key={series.id}>{series.name} <b>{writeNumber(value)}</b>{finite(low) && finite(high) ? ` [${writeNumber(low)}, ${writeNumber(high)}]` : ''}</span>)}</>;
}

// One curve at the cursor, as it is spoken.
function spokenAt(plots: readonly Plot[], x: number, chosen: string | null): string {
  const [plot] = plots;
  if (!plot) return '';
  const write = plot.x.write ?? ((value: number) => writeNumber(value, 4));
  return `${plots.map(each => each.x.name).find(Boolean) ?? 'at'} ${write(x)}, ${valuesAt(plot, x).filter(({series, value}) => finite(value) && (chosen === null || series.id === chosen))
    .map(({series, value, low, high}) => `${series.name} ${writeNumber(value)}${finite(low) && finite(high) ? `, ${writeNumber(low)} to ${writeNumber(high)}` : ''}`).join('; ')}`;
}

const SAY_MS = 500;
const PAPER_HEIGHT = 0.6;

export function Figure(props: FigureProps): JSX.Element {
  const {plots, name, title} = props;
  const [box, width] = useWidth();
  const id = useId().replace(/:/g, '');
  const [tableShown, setTableShown] = useState(false);
  const [spoken, setSpoken] = useState('');
  const [over, setOver] = useState<number | null>(null);
  const [drag, setDrag] = useState<[number, number] | null>(null);
  const [exploring, setExploring] = useState(false);
  const [curve, setCurve] = useState<string | null>(null);  // chosen by the arrows up and down
  const svg = useRef<SVGSVGElement>(null);
  const onPaper = document.documentElement.classList.contains('paper');  // which changes the width, so that this is read again
  const plan = useMemo(() => layout(plots, Math.max(width, 280), onPaper ? PAPER_HEIGHT : 1), [plots, width, onPaper]);
  const curves = (plots[0]?.series ?? []).filter(series => !series.hidden);
  const chosen = curves.find(series => series.id === curve);
  const xs = useMemo(() => chosen?.mark ? chosen.x : snapping(plots), [plots, chosen]);
  const log = plots[0]?.x.scale === 'log';
  const given = props.cursor ?? null;
  const [low, high] = plan.areas[0]?.x.domain ?? [0, 0];
  const at = over ?? given;
  const index = at === null || xs.length === 0 ? -1 : nearest(xs, at, log);
  const x = index < 0 || at === null || at < low || at > high ? null : xs[index]!;

  useEffect(() => {
    if (x === null || document.activeElement !== svg.current) return undefined;
    const timer = setTimeout(() => setSpoken(spokenAt(plots, x, curve)), SAY_MS);
    return () => clearTimeout(timer);
  }, [x, curve]);

  const pointed = (event: MouseEvent): number | null => {
    const place = plan.areas[0];
    const element = svg.current;
    if (!place || !element) return null;
    const rectangle = element.getBoundingClientRect();
    const pixel = (event.clientX - rectangle.left) * plan.width / rectangle.width;
    if (pixel < place.left - 12 || pixel > place.right + 12) return null;
    return place.x.invert(Math.min(Math.max(pixel, place.left), place.right));
  };
  const move = (event: MouseEvent): void => {
    const value = pointed(event);
    if (drag && value !== null) { setDrag([drag[0], value]); return; }
    const i = value === null || xs.length === 0 ? -1 : nearest(xs, value, log);
    const next = i < 0 ? null : xs[i]!;
    if (next !== over) { setOver(next); props.onCursor?.(next, false); }
  };
  const leave = (): void => { setOver(null); setDrag(null); props.onCursor?.(null, false); };
  const key = (event: KeyboardEvent): void => {
    const step = {ArrowLeft: -1, ArrowRight: 1}[event.key];
    const go = (i: number): void => { event.preventDefault(); props.onCursor?.(xs[Math.min(Math.max(i, 0), xs.length - 1)] ?? null, true); if (!props.onCursor) setOver(xs[Math.min(Math.max(i, 0), xs.length - 1)] ?? null); };
    if (step !== undefined) go(index < 0 ? (step > 0 ? 0 : xs.length - 1) : index + step);
    else if (event.key === 'Home') go(0);
    else if (event.key === 'End') go(xs.length - 1);
    else if ((event.key === 'ArrowUp' || event.key === 'ArrowDown') && curves.length > 0) {
      event.preventDefault();
      const at = chosen ? curves.indexOf(chosen) + (event.key === 'ArrowDown' ? 1 : -1) : 0;
      setCurve(curves[(at + curves.length) % curves.length]!.id);
      if (index < 0) go(0);
    } else if (event.key === 't') setTableShown(!tableShown);
    else if (event.key === 'Escape') { event.stopPropagation(); setOver(null); props.onCursor?.(null, true); }
    else if (event.key === 'Enter' && x !== null) props.onCursor?.(x, true);
  };
  const table = (): Table => tableOf(plots);
  const body = <>
    <div class="ptop"><h2>{title}</h2>{props.controls}{props.sub && <span class="sub">{props.sub}</span>}
      <Tools title={title} tableShown={tableShown} onTable={() => setTableShown(!tableShown)} curl={props.curl} how={props.how}
        onSvg={() => { if (svg.current) save(`${name}.svg`, 'image/svg+xml', svgText([svg.current], `${title}. ${props.describe}`, props.source)); }}
        onCsv={() => save(`${name}.csv`, 'text/csv', csvOf(table()))} />
    </div>
    {props.readout && <div class="readout">{x === null ? props.quietReadout ?? <span>Move over the figure, or focus it and use the arrow keys.</span> : <>{props.readout(x)}{exploring && chosen && <span>↑↓ {chosen.name}</span>}</>}</div>}
    <div class="figure" ref={box}>
      <div class="visually-hidden" aria-live="polite">{spoken}</div>
      {width > 0 && <svg ref={svg} viewBox={`0 0 ${plan.width} ${Math.ceil(plan.height)}`} width={plan.width} height={Math.ceil(plan.height)} tabindex={0} role={exploring ? 'application' : 'img'}
        aria-label={`${title}. ${props.describe} Arrow keys left and right move along the points, up and down choose the curve, Enter pins, t shows the table.`}
        onFocus={() => setExploring(true)} onBlur={() => { setExploring(false); setCurve(null); }}
        onMouseMove={move} onMouseLeave={leave} onKeyDown={key}
        onMouseDown={event => { const value = pointed(event); if (props.onZoom && value !== null) { event.preventDefault(); setDrag([value, value]); } }}
        onMouseUp={event => {
          const value = pointed(event);
          const pixels = drag && plan.areas[0] ? Math.abs(plan.areas[0].x(drag[1]) - plan.areas[0].x(drag[0])) : 0;
          if (drag && pixels > 6) props.onZoom?.(Math.min(...drag), Math.max(...drag));
          else if (value !== null && xs.length > 0) props.onCursor?.(xs[nearest(xs, value, log)] ?? null, true);
          setDrag(null);
        }}>
        <Drawing plan={plan} id={id} cursor={<g data-cursor="">
          {x !== null && plan.areas.map(place => <g key={place.plot.id}>
            <line x1={place.x(x)} x2={place.x(x)} y1={place.top} y2={place.bottom} stroke="var(--focus)" stroke-width="1.2" />
            {valuesAt(place.plot, x).filter(v => finite(v.value) && (chosen && place === plan.areas[0] ? v.series === chosen : v.series.mark)).slice(0, 1).map(v => <circle key={v.series.id} cx={place.x(x)} cy={place.y(v.value!)} r="5.5" fill="none" stroke="var(--focus)" stroke-width="1.6" />)}
          </g>)}
          {drag && plan.areas[0] && <rect x={Math.min(plan.areas[0].x(drag[0]), plan.areas[0].x(drag[1]))} width={Math.abs(plan.areas[0].x(drag[1]) - plan.areas[0].x(drag[0]))} y={plan.areas[0].top} height={plan.areas[0].bottom - plan.areas[0].top} fill="var(--focus)" opacity="0.15" />}
        </g>} />
      </svg>}
    </div>
    {tableShown && <TableView table={table()} />}
    {props.note && <p class="note">{props.note}</p>}
  </>;
  return props.plain ? <div>{body}</div> : <section class="panel">{body}</section>;
}
