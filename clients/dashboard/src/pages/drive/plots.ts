// Errors of measured outages as figures draw them: how they grow, and one by one.
import type {Mark, Plot, Series} from '../../figure/spec';
import {errorOf, type Duration, type Growth, type Simulated} from './documents';

const curve = (id: string, name: string, growth: Growth, more: Partial<Series>): Series => ({id, name, x: growth.time_s, y: growth.rms_m, line: true, colour: 'var(--measured)', ...more});
const simulation = (id: string, name: string, growth: Growth): Series => curve(id, name, growth, {detail: 'middle 90 %', low: growth.p05_m, high: growth.p95_m, band: 'var(--modelband)', colour: 'var(--model)', width: 2});

// How the error grows while fixes are withheld, over what a simulation of the same outages gives; of an explanation before and after mending.
export function growthPlots(of: Duration, simulated?: Simulated, was?: Duration, wasSimulated?: Simulated): Plot[] {
  const end = (id: string, name: string, value: number, mark: Mark): Series => ({id, name, x: [of.duration_s], y: [value], mark, colour: 'var(--ink2)'});
  const series = [of.growth && curve('measured', was ? 'mended' : 'measured, rms', of.growth, {mark: 'dot', width: 0.8}),
    was?.growth && curve('before', 'as it was', was.growth, {mark: 'open', width: 0.8, colour: 'var(--robust)'}),
    simulated?.growth && simulation('simulated', was ? 'simulated, mended' : 'simulated', simulated.growth),
    wasSimulated?.growth && curve('simulated-before', 'simulated, as it was', wasSimulated.growth, {dash: '2 3.5', colour: 'var(--model)'}),
    ...(was ? [] : [of.growth && curve('median', 'median', {...of.growth, rms_m: of.growth.median_m}, {dash: '4 4'})]),
    end('promised', 'by its covariance', of.promised_rms_m, 'diamond'), end('straight', 'straight line', of.straight_line_rms_m, 'triangle')];
  const drawn = series.filter(one => one !== undefined);
  const values = drawn.flatMap(one => one.y).filter(Number) as number[];
  return [{id: 'error', height: 260, x: {scale: 'log', name: 'time without fixes, s'}, y: {scale: 'log', name: 'horizontal error, m', domain: [Math.min(...values) / 1.5, Math.max(...values) * 1.5]}, series: drawn}];
}

const MOTIONS: readonly (readonly [string, string, Mark])[] = [['straight', 'straight on', 'dot'], ['turning', 'turning', 'triangle'], ['rest', 'at rest', 'open']];

// Every outage of one duration where it began.
export function outagesPlot(of: Duration): Plot {
  const series = MOTIONS.filter(([motion]) => of.outages.some(outage => outage.motion === motion)).map(([motion, name, mark]): Series => {
    const mine = of.outages.filter(outage => outage.motion === motion).sort((a, b) => a.start_s - b.start_s);
    return {id: motion, name, x: mine.map(outage => outage.start_s), y: mine.map(errorOf), mark, colour: 'var(--measured)'};
  });
  const ends = [Math.min(...of.outages.map(outage => outage.start_s)), Math.max(...of.outages.map(outage => outage.start_s))];
  const room = Math.max((ends[1]! - ends[0]!) * 0.03, 1);
  const promised: Series = {id: 'promised', name: 'promised rms', x: [ends[0]! - room, ends[1]! + room], y: [of.promised_rms_m, of.promised_rms_m], line: true, colour: 'var(--model)', dash: '2 3.5', width: 1.6};
  return {id: 'outages', height: 200, x: {scale: 'linear', name: 'start of the outage, s', domain: [ends[0]! - room, ends[1]! + room]}, y: {scale: 'log', name: `error after ${of.duration_s} s, m`}, series: [...series, promised]};
}
