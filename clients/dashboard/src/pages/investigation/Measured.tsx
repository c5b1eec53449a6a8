// Measured against simulated: what the baseline says, and what remains against the extended model, on the same axes.
import type {JSX} from 'preact';
import {useMemo} from 'preact/hooks';
import {Figure, Tools} from '../../figure/Figure';
import {save} from '../../figure/export';
import {Spectrogram, ratiosCsv} from '../../figure/Spectrogram';
import {finite, type Plot, type Series, type Zone} from '../../figure/spec';
import {writeTick} from '../../format/number';
import {capital, writeUnit} from '../../format/words';
import {choose, usePlace} from '../../route';
import {curlOf} from '../../shell/copy';
import {Panel} from '../../shell/states';
import {causeName, columnOf, frequencyOf, keyOf, type Finding, type Investigation, type SeriesDocument} from './documents';

const over = (values: readonly (number | null)[], by: readonly (number | null)[]): (number | null)[] => values.map((value, i) => { const base = by[i]; return value === null || base === null || base === undefined || base <= 0 ? null : value / base; });
const hertz = (f: number): string => `${writeTick(Number(f.toPrecision(4)))} Hz`;

// Findings of this channel that are lines, at their frequencies.
function linesOf(found: Investigation, one: SeriesDocument, chosen: string | null): Zone[] {
  return found.findings.flatMap((finding: Finding): Zone[] => {
    const f = frequencyOf(finding);
    if (f === null || !finding.channels.some(channel => columnOf(channel) === columnOf(one.channel))) return [];
    return [{from: f, to: f, style: 'mark', colour: keyOf(finding, found.findings) === chosen ? 'var(--ink)' : 'var(--model)', text: hertz(f)}];
  }).sort((a, b) => a.from - b.from);
}

// What is left and higher than chance lets the highest of all ordinates be: the highest of each run of such bins. The first bin holds
// whatever is slower than a stretch, which is no line.
export function leftOver({spectrum}: SeriesDocument): number[] {
  const above = spectrum.highest_remaining.map((value, i) => { const limit = spectrum.chance[i]; return i > 0 && finite(value) && finite(limit) && limit > 0 ? value / limit : 0; });
  return spectrum.f_hz.filter((_, i) => above[i]! > 1 && above[i]! >= (above[i - 1] ?? 0) && above[i]! > (above[i + 1] ?? 0));
}

function plotsOf(found: Investigation, one: SeriesDocument, chosen: string | null): Plot[] {
  const {spectrum} = one;
  const base = spectrum.baseline.median;
  const spectra = (id: string, name: string, values: readonly (number | null)[], highest: readonly (number | null)[], zones: Zone[]): Plot => ({
    id, height: 130, hideX: id === 'before', x: {scale: 'linear', name: id === 'before' ? '' : 'frequency, Hz'}, y: {scale: 'log', name, domain: [0.05, Math.max(20, ...over(spectrum.highest, base).map(value => (value ?? 0) * 1.3))]}, rules: [1], zones,
    series: [
      {id: `${id}-highest`, name: 'highest of each bin', x: spectrum.f_hz, y: over(highest, base), line: true, colour: 'var(--robust)', width: 1, noKey: true},
      {id: `${id}-chance`, name: 'chance, 1 in 20', x: spectrum.f_hz, y: over(spectrum.chance, base), line: true, colour: 'var(--ink3)', width: 1, noKey: true},
      {id: `${id}-spectrum`, name: 'mean', noKey: true, x: spectrum.f_hz, y: over(values, base), low: over(spectrum.baseline.q025, base), high: over(spectrum.baseline.q975, base), band: 'var(--modelband)', line: true, colour: 'var(--measured)', width: 1},
    ],
  });
  const left = leftOver(one).map((f): Zone => ({from: f, to: f, style: 'mark', colour: 'var(--robust)', text: hertz(f)}));
  return [spectra('before', 'before: measured ÷ baseline', spectrum.measured, spectrum.highest, linesOf(found, one, chosen)), spectra('after', 'after: what remains ÷ baseline', spectrum.remaining, spectrum.highest_remaining, left)];
}

// What the checks judge: the wavelet variance of the innovations of one recording over that of a right model.
function innovationPlots(one: SeriesDocument, recording: string): Plot[] {
  const ratios = (one.innovations ?? []).filter(ratio => ratio.recording === recording);
  const x = ratios.map(ratio => ratio.scale_s);
  const [low, high] = [ratios.map(ratio => ratio.q025), ratios.map(ratio => ratio.q975)];
  const all = ratios.flatMap(ratio => [ratio.before, ratio.after, ratio.q025, ratio.q975]).filter((value): value is number => finite(value) && value > 0);
  const domain: [number, number] = [Math.min(0.7, ...all) / 1.1, Math.max(1.4, ...all) * 1.1];
  const plot = (id: string, name: string, values: readonly (number | null)[]): Plot => {
    const outside = values.map((value, i) => finite(value) && (value < (low[i] ?? 0) || value > (high[i] ?? Infinity)));
    const series: Series[] = [
      {id: `${id}-measured`, name: 'innovations', x, y: values, mark: 'dot', colour: 'var(--measured)', colours: outside.map(out => out ? 'var(--robust)' : 'var(--measured)'), noKey: true},
      {id: `${id}-band`, name: 'a right model, 95 %', x, y: x.map(() => 1), low, high, band: 'var(--modelband)', line: true, colour: 'var(--model)', noKey: true},
    ];
    return {id, height: 130, hideX: id === 'before', x: {scale: 'log', name: id === 'before' ? '' : 'scale, s'}, y: {scale: 'log', name, domain, write: writeTick}, rules: [1], series};
  };
  return [plot('before', 'before: innovations ÷ right model', ratios.map(ratio => ratio.before)), plot('after', 'after', ratios.map(ratio => ratio.after))];
}

export function Measured({found, one, names}: {found: Investigation; one: SeriesDocument; names: ReadonlyMap<string, string>}): JSX.Element {
  const {query} = usePlace();
  const chosen = query.get('finding');
  const recordings = [...new Set((one.innovations ?? []).map(ratio => ratio.recording))];
  const recording = recordings.find(id => id === query.get('rec')) ?? recordings[0] ?? '';
  const spectra = useMemo(() => plotsOf(found, one, chosen), [found, one, chosen]);
  const innovations = useMemo(() => innovationPlots(one, recording), [one, recording]);
  const lines = linesOf(found, one, chosen).length;
  const left = leftOver(one);
  const source = `driftlab, ${found.id}, ${columnOf(one.channel)}`;
  const curl = curlOf(`/v1/investigations/${found.id}`);
  const changes = one.spectrogram;
  const picture = 'Spectrogram of the innovations';
  const picked = found.findings.find(finding => keyOf(finding, found.findings) === chosen);
  return <div class="grid wide-side">
    <Figure name={`${found.id}-spectrum`} title="Spectrum" sub={<span>{columnOf(one.channel)}, mean of all recordings · <span style={{color: 'var(--robust)'}}>highest of each bin</span> · what chance reaches</span>} plots={spectra} source={source} curl={curl}
      describe={`Two-sided density of ${columnOf(one.channel)} in ${writeUnit(one.unit)}²/Hz over the baseline, before and after the findings; ${lines} lines found, ${left.length} left over.`}
      note={<><span style={{color: 'var(--model)'}}>▼</span> {lines === 0 ? 'no line was found' : `a line that was found${picked && frequencyOf(picked) !== null ? `; black: ${capital(causeName(picked.cause))}, ${hertz(frequencyOf(picked)!)}` : ''}`} · <span style={{color: 'var(--robust)'}}>▼</span> {left.length === 0 ? 'nothing is left above chance' : `left over, in no finding: ${left.slice(0, 6).map(hertz).join(', ')}${left.length > 6 ? ` and ${left.length - 6} more` : ''}`}</>} />
    {recordings.length > 0 && <Figure name={`${found.id}-innovations`} title="Innovations by scale"
      controls={recordings.length > 1 ? <label><span class="visually-hidden">Recording </span><select value={recording} onChange={event => choose({rec: event.currentTarget.value === recordings[0] ? null : event.currentTarget.value})}>{recordings.map(id => <option key={id} value={id}>{names.get(id) ?? id}</option>)}</select></label> : undefined}
      sub={<span><span style={{color: 'var(--model)'}}>band: a right model, 95 %</span></span>} plots={innovations} source={`${source}, ${recording}`} curl={curl}
      describe={`Wavelet variance of the innovations of ${names.get(recording) ?? recording} over that of a right model by scale, before and after the findings: what the checks judge.`}
      note="One is right; vermilion lies outside the range of one scale alone. The checks judge all scales of all recordings together." />}
    {changes && <Panel title={picture} sub={names.get(changes.recording) ?? changes.recording} tools={<Tools title={picture} curl={curl} onCsv={() => save(`${found.id}-spectrogram.csv`, 'text/csv', ratiosCsv(changes))} />}>
      <Spectrogram spectrogram={changes} name={picture} />
      <p class="note">What is left over the level of a right model, where that changes most; full colour is ten times more or less.</p>
    </Panel>}
  </div>;
}
