// Errors of measured outages as figures draw them: by how long they last, and one by one.
import type {Nullable} from '../../api/documents';
import {writeTick} from '../../format/number';
import {finite, type Axis, type Mark, type Plot, type Series} from '../../figure/spec';
import {errorOf, type Duration, type Simulated} from './documents';

const duration = (name: string, durations: readonly Duration[]): Axis => ({scale: 'log', name, ticks: durations.map(each => each.duration_s), domain: [durations[0]!.duration_s / 1.25, durations[durations.length - 1]!.duration_s * 1.25]});

function measured(id: string, name: string, durations: readonly Duration[], mark: Mark, more: Partial<Series> = {}): Series {
  const ends = (i: 0 | 1): Nullable => durations.map(each => each.rms_m.ci95[i] ?? null);
  return {id, name, x: durations.map(each => each.duration_s), y: durations.map(each => each.rms_m.value), low: ends(0), high: ends(1), mark, line: true, colour: 'var(--measured)', width: 0.8, ...more};
}

const ofSimulated = (simulated: readonly Simulated[], id: string, name: string, more: Partial<Series> = {}): Series => ({id, name, x: simulated.map(each => each.duration_s), y: simulated.map(each => each.rms_m), line: true, colour: 'var(--model)', width: 2, ...more});

function ratio(id: string, name: string, simulated: readonly Simulated[], mark: Mark): Series {
  const ends = (i: 0 | 1): Nullable => simulated.map(each => each.measured_over_simulated.ci95[i] ?? null);
  return {id, name, noKey: true, x: simulated.map(each => each.duration_s), y: simulated.map(each => each.measured_over_simulated.value), low: ends(0), high: ends(1), mark, colour: 'var(--measured)'};
}

const NAME = 'without fixes, s';
const ERROR = 'horizontal error, rms, m';

// Measured with its interval; what the model promises, by simulation where there is one; a straight line for scale.
export function errorPlots(durations: readonly Duration[], simulated: readonly Simulated[] | undefined): Plot[] {
  const x = durations.map(each => each.duration_s);
  const line = (id: string, name: string, y: number[], more: Partial<Series>): Series => ({id, name, x, y, line: true, colour: 'var(--model)', ...more});
  const series = [measured('measured', 'measured', durations, 'dot'), ...(simulated ? [ofSimulated(simulated, 'simulated', 'simulated')] : []),
    line('promised', 'by its covariance', durations.map(each => each.promised_rms_m), {dash: '2 3.5', width: 1.6}),
    line('straight', 'straight line', durations.map(each => each.straight_line_rms_m), {dash: '4 4', colour: 'var(--c-dr)'})];
  const main: Plot = {id: 'error', height: 240, x: duration(simulated ? '' : NAME, durations), y: {scale: 'log', name: ERROR}, series};
  return simulated ? [main, ratioPlot(durations, [ratio('ratio', 'measured ÷ simulated', simulated, 'dot')])] : [main];
}

// Before and after mending, each against its own simulation.
export function mendedPlots(before: {durations: Duration[]; simulated: Simulated[]}, after: {durations: Duration[]; simulated: Simulated[]}): Plot[] {
  return [{id: 'error', height: 240, x: duration('', before.durations), y: {scale: 'log', name: ERROR},
    series: [measured('before', 'as it was', before.durations, 'dot', {colour: 'var(--robust)'}), measured('after', 'mended', after.durations, 'open'), ofSimulated(after.simulated, 'simulated', 'simulated, mended'), ofSimulated(before.simulated, 'simulated-before', 'simulated, as it was', {dash: '2 3.5', width: 1.6})]},
  ratioPlot(before.durations, [{...ratio('before-ratio', 'as it was', before.simulated, 'dot'), colour: 'var(--robust)'}, ratio('after-ratio', 'mended', after.simulated, 'open')])];
}

// One, where the simulation is right, is always in sight.
function ratioPlot(durations: readonly Duration[], series: Series[]): Plot {
  const ends = [1, ...series.flatMap(one => [...one.y, ...one.low ?? [], ...one.high ?? []])].filter((value): value is number => finite(value) && value > 0);
  return {id: 'ratio', height: 110, rules: [1], x: duration(NAME, durations), y: {scale: 'log', name: 'measured ÷ simulated', write: writeTick, domain: [Math.min(...ends) / 1.2, Math.max(...ends) * 1.2]}, series};
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
