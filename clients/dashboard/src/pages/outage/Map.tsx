// The drive in metres, north up, with its outages as thick strokes and the chosen one enlarged.
import type {JSX} from 'preact';
import {barLength} from '../../format/bar';
import {writeTick} from '../../format/number';
import {at95, type Evaluation, type Filter, type Path, type Track} from './documents';

const WIDTH = 420;
const HEIGHT = 460;
const PAD = 46;

interface View { x(east: number): number; y(north: number): number; scale: number }

function viewOf(east: number[], north: number[], left: number, top: number, width: number, height: number): View {
  const [e0, e1, n0, n1] = [Math.min(...east), Math.max(...east), Math.min(...north), Math.max(...north)];
  const scale = Math.min(width / Math.max(e1 - e0, 1), height / Math.max(n1 - n0, 1));
  const midE = (e0 + e1) / 2;
  const midN = (n0 + n1) / 2;
  return {x: east => left + width / 2 + (east - midE) * scale, y: north => top + height / 2 - (north - midN) * scale, scale};
}

// Ten points a second where the evaluation kept them, else the path of the whole drive.
const around = (track: Track | undefined, path: Path): Path => !track || track.start_s === null ? path : {...track, time_s: track.north_m.map((_, i) => track.start_s! + i / track.rate_hz)};
const stretch = (path: Path, from: number, to: number): number[] => path.time_s.map((_, i) => i).filter(i => path.time_s[i]! >= from && path.time_s[i]! <= to);
const points = (path: Path, indices: number[], view: View): string => indices.map(i => `${view.x(path.east_m[i]!).toFixed(1)},${view.y(path.north_m[i]!).toFixed(1)}`).join(' ');

// What a filter believes of its own error at the end of an outage, around where it believes to be.
function Belief({filter, outage, path, indices, zoom, colour}: {filter: Filter; outage: number; path: Path; indices: number[]; zoom: View; colour: string}): JSX.Element | null {
  const last = indices[indices.length - 1];
  const ellipse = at95(filter.outages[outage]!.predicted.ellipses);
  if (last === undefined || !ellipse) return null;
  const [x, y] = [zoom.x(path.east_m[last]!), zoom.y(path.north_m[last]!)];
  return <ellipse cx={x} cy={y} rx={ellipse.semi_major_m * zoom.scale} ry={ellipse.semi_minor_m * zoom.scale} transform={`rotate(${ellipse.major_axis_azimuth_deg - 90} ${x} ${y})`} fill="none" stroke={colour} stroke-width="1.2" />;
}

export function DriveMap({evaluation, outage, left, right}: {evaluation: Evaluation; outage: number; left: Filter; right: Filter}): JSX.Element {
  const {trajectory} = evaluation;
  const all = trajectory.time_s.map((_, i) => i);
  const view = viewOf(trajectory.east_m, trajectory.north_m, PAD, PAD, WIDTH - 2 * PAD, HEIGHT - 2 * PAD - 20);
  const outages = left.outages;
  const chosen = outages[outage]!;
  const truth = around(evaluation.tracks?.[outage], trajectory);
  const near = stretch(truth, chosen.start_s - 6, chosen.end_s + 1);
  const filters = [left, right].map(filter => {
    const path = around(filter.outages[outage]?.track, filter.trajectory);
    return {filter, path, indices: stretch(path, chosen.start_s - 6, chosen.end_s)};
  });
  const inset = {left: WIDTH * 0.28, top: HEIGHT * 0.22, size: WIDTH * 0.46};
  const zoom = viewOf([...near.map(i => truth.east_m[i]!), ...filters.flatMap(({path, indices}) => indices.map(i => path.east_m[i]!))],
    [...near.map(i => truth.north_m[i]!), ...filters.flatMap(({path, indices}) => indices.map(i => path.north_m[i]!))], inset.left + 26, inset.top + 22, inset.size - 52, inset.size - 80);
  const bar = barLength(view.scale, 110);
  const zoomBar = barLength(zoom.scale, 60);
  const middle = near[Math.floor(near.length / 2)] ?? 0;
  const [atX, atY] = [view.x(truth.east_m[middle]!), view.y(truth.north_m[middle]!)];
  return <svg viewBox={`0 0 ${WIDTH} ${HEIGHT}`} width="100%" role="img" aria-label={`The drive with ${outages.length} outages; outage ${chosen.index} enlarged with ${left.name} and ${right.name}.`}>
    <polyline points={points(trajectory, all, view)} fill="none" stroke="var(--rule)" stroke-width="1.2" />
    {outages.map((each, i) => {
      const indices = stretch(trajectory, each.start_s, each.end_s);
      const last = indices[indices.length - 1] ?? 0;
      return <g key={each.index}><polyline points={points(trajectory, indices, view)} fill="none" stroke="var(--ink)" stroke-width={i === outage ? 6 : 4.5} stroke-linecap="round" />
        <text class="b h" x={view.x(trajectory.east_m[last]!) + 11} y={view.y(trajectory.north_m[last]!) + 4}>{each.index}</text></g>;
    })}
    <circle cx={view.x(trajectory.east_m[0] ?? 0)} cy={view.y(trajectory.north_m[0] ?? 0)} r="3.5" fill="var(--surface)" stroke="var(--ink)" stroke-width="1.4" />
    <text class="s h" x={view.x(trajectory.east_m[0] ?? 0) + 8} y={view.y(trajectory.north_m[0] ?? 0) + 4}>start</text>
    <circle cx={atX} cy={atY} r="17" fill="none" stroke="var(--focus)" stroke-width="1.2" />
    <line x1={atX} y1={atY} x2={inset.left + inset.size / 2} y2={inset.top + inset.size / 2} stroke="var(--focus)" stroke-width="0.8" opacity="0.6" />
    <rect x={inset.left} y={inset.top} width={inset.size} height={inset.size} fill="var(--surface)" stroke="var(--hair)" />
    <polyline points={points(truth, near, zoom)} fill="none" stroke="var(--rule)" stroke-width="2.5" />
    {filters.map(({filter, path, indices}, i) => { const colour = i === 0 ? 'var(--robust)' : 'var(--model)'; return <g key={filter.name}><polyline points={points(path, indices, zoom)} fill="none" stroke={colour} stroke-width="1.6" />
      <Belief filter={filter} outage={outage} path={path} indices={indices} zoom={zoom} colour={colour} /></g>; })}
    <line class="ax" x1={inset.left + 12} x2={inset.left + 12 + zoomBar * zoom.scale} y1={inset.top + 20} y2={inset.top + 20} /><text class="s" x={inset.left + 12} y={inset.top + 14}>{writeTick(zoomBar)} m</text>
    <text class="s" x={inset.left + 10} y={inset.top + inset.size - 37} style={{fill: 'var(--robust)'}}>{left.name}</text>
    <text class="s" x={inset.left + 10} y={inset.top + inset.size - 24} style={{fill: 'var(--model)'}}>{right.name}</text>
    <text class="s" x={inset.left + 10} y={inset.top + inset.size - 10}>first run, 95 % ellipse at its end</text>
    <path class="ax" d={`M20,${HEIGHT - 18}v-5v5h${bar * view.scale}v-5`} /><text x={20 + bar * view.scale / 2} y={HEIGHT - 26} text-anchor="middle">{writeTick(bar)} m</text>
    <text x={WIDTH - 22} y={HEIGHT - 18} text-anchor="end">N ↑</text>
  </svg>;
}
