// The curves of one characterised channel as a figure draws them. Their laws come from the API; here are units and names.
import type {Channel, Implied, ModelFit, Nullable} from '../../api/documents';
import {writeQuantity, writeTick} from '../../format/number';
import {factorBetween} from '../../format/units';
import {processName, writeUnit} from '../../format/words';
import type {Note, Plot, Series} from '../../figure/spec';
import {finite, valueAt} from '../../figure/spec';

export type Curve = 'allan' | 'haar';
export interface Shown { robust: boolean; components: boolean; guides: boolean }

interface Style { colour: string; dash: string }
const STYLES: Record<string, Style[]> = {
  white_noise: [{colour: 'var(--c-wn)', dash: '7 4'}],
  gauss_markov: [{colour: 'var(--c-gm)', dash: '2 3.5'}, {colour: 'var(--c-gm2)', dash: '1 3'}],
  random_walk: [{colour: 'var(--c-rw)', dash: '10 3 2 3'}],
  linear_drift: [{colour: 'var(--c-dr)', dash: '4 4'}],
  quantization_noise: [{colour: 'var(--c-qn)', dash: '1 1'}],
};
export const styleOf = (process: string, nth: number): Style => STYLES[process]?.[nth] ?? STYLES[process]?.[0] ?? {colour: 'var(--c-dr)', dash: '4 4'};

const times = (values: Nullable, factor: number): Nullable => values.map(value => value === null ? null : value * factor);
const roots = (values: Nullable, factor: number): Nullable => values.map(value => value === null || value < 0 ? null : Math.sqrt(value) * factor);

// Allan variance is twice the Haar wavelet variance at the same time.
const HAAR = 1 / Math.SQRT2;

function robustSeries(channel: Channel, factor: number, curve: Curve): Series | null {
  const {haar} = channel;
  if (!haar.robust) return null;
  const scaled = factor * (curve === 'allan' ? Math.SQRT2 : 1);
  return {
    id: 'robust', name: 'robust', detail: robustDetail(channel), x: haar.scale.map(scale => scale / 2 * channel.dt_s), y: roots(haar.robust.variance, scaled),
    low: roots(haar.robust.ci95.map(ends => ends?.[0] ?? null), scaled), high: roots(haar.robust.ci95.map(ends => ends?.[1] ?? null), scaled),
    mark: 'diamond', line: true, colour: 'var(--robust)', band: 'var(--robustband)', width: 1.2,
  };
}

function robustDetail(channel: Channel): string {
  const disjoint = channel.contamination?.disjoint_scales.length ?? 0;
  return disjoint > 0 ? `${disjoint} of ${channel.haar.scale.length} scales differ` : 'agrees';
}

export function measuredSeries(channel: Channel, factor: number, curve: Curve): Series {
  const base = {id: 'classical', name: 'classical', detail: '95 % interval', mark: 'dot' as const, line: true, colour: 'var(--measured)', band: 'var(--band)', width: 0.8};
  if (curve === 'allan') {
    const {allan} = channel;
    return {...base, x: allan.tau_s, y: times(allan.deviation, factor), low: times(allan.ci95.map(ends => ends[0] ?? null), factor), high: times(allan.ci95.map(ends => ends[1] ?? null), factor)};
  }
  const {haar} = channel;
  return {...base, x: haar.scale.map(scale => scale / 2 * channel.dt_s), y: roots(haar.variance, factor), low: roots(haar.ci95.map(ends => ends[0] ?? null), factor), high: roots(haar.ci95.map(ends => ends[1] ?? null), factor)};
}

export function componentSeries(implied: Implied, factor: number): Series[] {
  const seen = new Map<string, number>();
  return implied.allan.components.map((component, i) => {
    const nth = seen.get(component.process) ?? 0;
    seen.set(component.process, nth + 1);
    const style = styleOf(component.process, nth);
    return {id: `component-${i}`, name: processName(component.process) + (nth > 0 ? ` ${nth + 1}` : ''), x: implied.allan.tau_s, y: times(component.deviation, factor), line: true, colour: style.colour, dash: style.dash};
  });
}

export function variancePlots(channel: Channel, fit: ModelFit | undefined, implied: Implied | null, unit: string, curve: Curve, shown: Shown): Plot[] {
  const factor = factorBetween(channel.unit, unit);
  const law = factor * (curve === 'haar' ? HAAR : 1);
  const robust = robustSeries(channel, factor, curve);
  const components = implied && shown.components && implied.allan.components.length > 1 ? componentSeries(implied, law) : [];
  const model: Series[] = implied && fit ? [{id: 'model', name: fit.model, detail: fit.robust ? 'fitted to robust' : 'fitted', x: implied.allan.tau_s, y: times(implied.allan.deviation, law), line: true, colour: 'var(--model)', width: 2}] : [];
  const measured = measuredSeries(channel, factor, curve);
  const name = curve === 'allan' ? 'Allan deviation' : 'Haar wavelet deviation';
  const main: Plot = {
    id: 'variance', equalDecades: true, x: {scale: 'log', name: implied ? '' : 'averaging time τ, s'}, y: {scale: 'log', name: `${name}, ${writeUnit(unit)}`},
    series: [measured, ...(robust && shown.robust ? [robust] : []), ...model, ...components],
    notes: notesOf(channel, fit, components, unit, curve), guides: shown.guides ? [{slope: -1, text: '−1'}, {slope: -0.5, text: '−½'}, {slope: 0, text: '0'}, {slope: 0.5, text: '+½'}, {slope: 1, text: '+1'}] : [],
  };
  return implied ? [main, ratioPlot(measured, robust && shown.robust ? robust : null, implied, law)] : [{...main, x: {scale: 'log', name: 'averaging time τ, s'}}];
}

// Measured over model, on a scale on which misfit shows.
function ratioPlot(measured: Series, robust: Series | null, implied: Implied, law: number): Plot {
  const curve: Series = {id: 'curve', name: 'model', x: implied.allan.tau_s, y: times(implied.allan.deviation, law), colour: ''};
  const exact = new Map(implied.ratio.tau_s.map((tau, i) => [tau, implied.ratio.deviation[i] ?? null] as const));
  const modelAt = (x: number): number | null => { const value = exact.get(x); return value !== undefined && value !== null ? value * law : valueAt(curve, x, true); };
  const over = (series: Series, values: readonly (number | null)[] | undefined): Nullable => series.x.map((x, i) => { const value = values?.[i]; const model = modelAt(x); return finite(value) && finite(model) && model > 0 ? value / model : null; });
  const ratio = (series: Series, id: string): Series => ({id, name: `${series.name} ÷ model`, noKey: true, x: series.x, y: over(series, series.y), low: over(series, series.low), high: over(series, series.high), ...(series.mark ? {mark: series.mark} : {}), colour: series.colour});
  const far = Math.max(0.25, ...over(measured, measured.y).filter(finite).map(value => Math.abs(Math.log(value))));
  const limit = Math.min(Math.exp(far * 1.25), 8);
  const ticks = limit > 2.2 ? [0.5, 1, 2] : limit > 1.6 ? [0.67, 1, 1.5] : [0.8, 1, 1.25];
  return {
    id: 'ratio', height: 96, x: {scale: 'log', name: 'averaging time τ, s'}, rules: [1],
    y: {scale: 'log', name: 'measured ÷ model', domain: [1 / limit, limit], ticks, write: value => value === 1 ? '1' : writeTick(value)},
    series: [ratio(measured, 'classical-ratio'), ...(robust ? [ratio(robust, 'robust-ratio')] : [])],
  };
}

// What a reader takes off the figure: N at 1 s, K at 3 s, B as a line; each only where the data identify it.
function notesOf(channel: Channel, fit: ModelFit | undefined, components: readonly Series[], unit: string, curve: Curve): Note[] {
  const notes: Note[] = [];
  if (curve !== 'allan') return notes;
  fit?.processes.forEach((process, i) => {
    const component = components[i];
    const [level, estimate] = Object.entries(process.params)[0] ?? [];
    if (!component || !estimate || estimate.value === null || !level) return;
    const at = process.process === 'white_noise' ? 1 : process.process === 'random_walk' ? 3 : null;
    const y = at === null ? null : valueAt(component, at, true);
    if (at === null || !finite(y)) return;
    const ends = channel.allan.tau_s;
    if (at < (ends[0] ?? 0) || at > (ends[ends.length - 1] ?? 0)) return;
    notes.push({x: at, y, text: `${level} = ${writeQuantity(estimate).value} ${writeUnit(estimate.unit)}`, sub: `read at τ = ${at} s`, drop: true, ring: true, colour: component.colour});
  });
  const bias = channel.allan_parameters.B;
  if (bias && bias.value !== null && factorBetween(bias.unit, unit) > 0) {
    const level = bias.value * factorBetween(bias.unit, unit) * 0.664;
    const last = channel.allan.tau_s[channel.allan.tau_s.length - 1] ?? 1;
    notes.push({x: last, y: level, line: level, text: `B = ${writeQuantity(bias).value} ${writeUnit(bias.unit)}`, sub: 'line at 0.664 B'});
  }
  return notes;
}

// In words, for whoever does not see it.
export function describe(channel: Channel, fit: ModelFit | undefined, unit: string, curve: Curve): string {
  const {tau_s: tau, deviation} = channel.allan;
  const first = tau[0];
  const last = tau[tau.length - 1];
  const factor = factorBetween(channel.unit, unit);
  const least = deviation.reduce<number>((best, value, i) => value !== null && value < (deviation[best] ?? Infinity) ? i : best, 0);
  const at = (i: number): string => deviation[i] === null || deviation[i] === undefined ? '…' : `${writeTick(Number((deviation[i]! * factor).toPrecision(3)))} ${writeUnit(unit)}`;
  return `${curve === 'allan' ? 'Allan' : 'Haar wavelet'} deviation against averaging time from ${first} s to ${last} s, log-log with equal decades: ${at(0)} at the shortest time, least ${at(least)} at ${tau[least]} s, ${at(tau.length - 1)} at the longest.${fit ? ` Fitted model ${fit.model}.` : ''}`;
}
