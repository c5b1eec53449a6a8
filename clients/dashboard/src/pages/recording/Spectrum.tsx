// The density of what was measured under that of the model: lines, bumps and filters that an Allan deviation smears over an octave.
import type {JSX} from 'preact';
import {useMemo} from 'preact/hooks';
import {useRead} from '../../api/client';
import type {Channel, Implied, ModelFit, Nullable, Recording, Spectrum as SpectrumDocument} from '../../api/documents';
import {writeCount, writeNumber} from '../../format/number';
import {factorBetween} from '../../format/units';
import {processName, writeUnit} from '../../format/words';
import {defaultReadout, Figure} from '../../figure/Figure';
import type {Plot, Series} from '../../figure/spec';
import {curlOf} from '../../shell/copy';
import {Panel, Shown} from '../../shell/states';
import {styleOf} from './plots';

const times = (values: Nullable, factor: number): Nullable => values.map(value => value === null ? null : value * factor);

// 3.2 × 10⁻⁵ and 40 000 take too much room beside an axis: powers of ten do not.
const SUPERSCRIPTS = '⁰¹²³⁴⁵⁶⁷⁸⁹';
export function writePower(value: number): string {
  const e = Math.round(Math.log10(value));
  if (Math.abs(value / 10 ** e - 1) > 1e-6) return '';
  return e >= -2 && e <= 3 ? String(10 ** e) : `10${e < 0 ? '⁻' : ''}${[...String(Math.abs(e))].map(digit => SUPERSCRIPTS[Number(digit)]).join('')}`;
}

function spectrumPlots(spectrum: SpectrumDocument, fit: ModelFit | undefined, implied: Implied | null, unit: string, components: boolean): Plot[] {
  const square = factorBetween(spectrum.unit, unit) ** 2;
  const ends = (i: 0 | 1): Nullable => times(spectrum.ci95.map(each => each[i] ?? null), square);
  const measured: Series = {id: 'measured', name: 'measured', detail: spectrum.segments > 1 ? `mean of ${spectrum.segments} segments` : 'mean of five tapers', x: spectrum.f_hz, y: times(spectrum.density, square), low: ends(0), high: ends(1), band: 'var(--band)', line: true, colour: 'var(--measured)', width: 1.2};
  const greatest: Series = {id: 'greatest', name: 'greatest', detail: 'ordinate of each bin', x: spectrum.f_hz, y: times(spectrum.max, square), line: true, colour: 'var(--ink3)', width: 0.7};
  const seen = new Map<string, number>();
  const parts: Series[] = implied && components && implied.spectrum.components.length > 1 ? implied.spectrum.components.map((component, i) => {
    const nth = seen.get(component.process) ?? 0;
    seen.set(component.process, nth + 1);
    const style = styleOf(component.process, nth);
    return {id: `component-${i}`, name: processName(component.process) + (nth > 0 ? ` ${nth + 1}` : ''), x: implied.spectrum.f_hz, y: times(component.density, square), line: true, colour: style.colour, dash: style.dash};
  }) : [];
  const model: Series[] = implied && fit ? [{id: 'model', name: fit.model, detail: 'from the fit', x: implied.spectrum.f_hz, y: times(implied.spectrum.density, square), line: true, colour: 'var(--model)', width: 2}] : [];
  // What was measured decides the heights; a component that fades out below it is cut.
  const heights = [...measured.y, ...greatest.y].filter((value): value is number => value !== null && value > 0);
  const domain: [number, number] = heights.length > 0 ? [Math.min(...heights) / 2.5, Math.max(...heights) * 2] : [1e-3, 1];
  return [{id: 'spectrum', height: 240, x: {scale: 'log', name: 'frequency, Hz', domain: [spectrum.f_hz[0] ?? 1e-3, spectrum.f_hz[spectrum.f_hz.length - 1] ?? 1]}, y: {scale: 'log', name: `two-sided density, (${writeUnit(unit)})²/Hz`, domain, write: writePower}, series: [measured, ...model, ...parts, greatest]}];
}

export function SpectrumMethod(): JSX.Element {
  return <p>Spectrum: five sine tapers over the whole record, or over segments of 2²⁰ samples, averaged in bins of equal width in the logarithm of frequency. The interval is chi-square, for Gaussian noise. A line stands out in the greatest ordinate of its bin long before the mean of the bin rises.</p>;
}

interface SpectrumProps {
  recording: Recording;
  channel: Channel;
  fit: ModelFit | undefined;
  implied: Implied | null;
  unit: string;
  components: boolean;
  tau: number | null;
  onTau: (tau: number | null, pinned: boolean) => void;
}

export function Spectrum({recording, channel, fit, implied, unit, components, tau, onTau}: SpectrumProps): JSX.Element {
  const path = `/v1/recordings/${recording.id}/spectrum?channel=${encodeURIComponent(channel.channel)}`;
  const read = useRead<SpectrumDocument>(path);
  const plots = useMemo(() => read.data ? spectrumPlots(read.data, fit, implied, unit, components) : [], [read.data, fit, implied, unit, components]);
  if (!read.data) return <Panel title="Spectrum"><Shown read={read}>{() => null}</Shown></Panel>;
  const spectrum = read.data;
  const first = spectrum.f_hz[0] ?? 0;
  const last = spectrum.f_hz[spectrum.f_hz.length - 1] ?? 0;
  return <Figure name={`${recording.metadata.id ?? recording.id}-${channel.axis ?? channel.channel}-spectrum`} title="Spectrum" sub="cursor linked, f = 1/(2τ)"
    describe={`Two-sided power spectral density of ${channel.channel} from ${writeNumber(first, 2)} to ${writeNumber(last, 2)} Hz, with 95 % interval${fit ? ` and the density that ${fit.model} implies` : ''}.`}
    plots={plots} cursor={tau ? 1 / (2 * tau) : null} onCursor={(f, pinned) => onTau(f === null ? null : 1 / (2 * f), pinned)}
    readout={f => <><b>f {writeNumber(f, 4)} Hz</b>{defaultReadout(plots[0]!, f)}<span>({writeUnit(unit)})²/Hz</span></>} quietReadout={<span>Move over the figure: the Allan deviation shows the same place.</span>}
    source={`driftlab, ${recording.id} ${channel.channel}, revision ${recording.revision}`} curl={curlOf(path)}
    how={() => <><SpectrumMethod /><dl><dt>samples</dt><dd>{writeCount(spectrum.samples)}</dd><dt>segments</dt><dd>{spectrum.segments} of {writeCount(spectrum.segment_samples)} samples</dd><dt>taper</dt><dd>{spectrum.window}</dd></dl></>} />;
}
