// How each parameter moves with the dynamics: one small frame each, zero on every axis.
import type {JSX} from 'preact';
import {useMemo} from 'preact/hooks';
import {capital, writeSentence, writeUnit} from '../../format/words';
import {Figure} from '../../figure/Figure';
import type {Plot} from '../../figure/spec';
import {columnName, type Trend} from './documents';

const TOP = 1.12;

function plotOf(trend: Trend, colour: ReadonlyMap<string, string>): Plot {
  const most = Math.max(...trend.points.map(point => point.ci95[1] ?? point.value), ...trend.points.map(point => point.value));
  const far = Math.max(...trend.points.map(point => point.at), ...trend.left_out.map(point => point.at));
  return {
    id: 'trend', height: 130, x: {scale: 'linear', name: writeUnit(trend.against.unit), domain: [-far * 0.04, far * 1.06]}, y: {scale: 'linear', name: `${columnName(trend.parameter).symbol}, ${writeUnit(trend.unit)}`, domain: [0, most * TOP]},
    series: [{id: 'points', name: columnName(trend.parameter).symbol, noKey: true, x: trend.points.map(point => point.at), y: trend.points.map(point => point.value), low: trend.points.map(point => point.ci95[0] ?? null), high: trend.points.map(point => point.ci95[1] ?? null), mark: 'dot', colour: 'var(--measured)', colours: trend.points.map(point => colour.get(point.label) ?? 'var(--measured)')}],
    notes: trend.left_out.map(point => ({x: point.at, y: most * 0.06, text: '…', anchor: 'middle' as const})),
  };
}

export function words(trend: Trend): string {
  if (trend.monotone.direction === 'up') return 'rises';
  if (trend.monotone.direction === 'down') return 'falls';
  return trend.equal.p < 0.05 ? 'moves, no direction' : 'no change shown';
}

// `colour`: that of each condition by its label, as everywhere on the page.
export function TrendFrame({trend, device, colour}: {trend: Trend; device: string; colour: ReadonlyMap<string, string>}): JSX.Element {
  const plots = useMemo(() => [plotOf(trend, colour)], [trend, colour]);
  const name = columnName(trend.parameter);
  return <Figure plain name={`${device}-${trend.parameter}-trend`} title={`${name.process} ${name.symbol}`} sub={<span title={writeSentence(trend.statement)}>{words(trend)}</span>} plots={plots} source={`driftlab, ${device}`}
    describe={`${capital(name.process)} ${name.symbol} against ${trend.against.kind === 'rate' ? 'rate' : 'angular acceleration'} in ${writeUnit(trend.against.unit)}: ${words(trend)}. ${writeSentence(trend.statement)}`} />;
}
