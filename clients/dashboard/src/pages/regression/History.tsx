// What the runs of a device against one baseline say of a parameter: intervals against their margin, run by run.
import type {JSX} from 'preact';
import {useMemo} from 'preact/hooks';
import {writeTick} from '../../format/number';
import {conditionName} from '../../format/words';
import {curlOf} from '../../shell/copy';
import {defaultReadout, Figure} from '../../figure/Figure';
import {finite, type Plot, type Series} from '../../figure/spec';
import {columnName} from '../device/documents';
import type {ParameterTest, RegressionRun} from './documents';

export const parameterName = (name: string): string => { const {process, symbol} = columnName(name); return `${process} ${symbol}`; };

export const axisName = (of: {sensor: string; axis: string; condition: string}): string => `${of.sensor} ${of.axis}, ${of.condition.includes(':') ? of.condition.split(':').slice(1).join(' ') : conditionName({kind: of.condition})}`;

const MARKS = {fail: ['square', 'var(--robust)'], inconclusive: ['open', 'var(--measured)'], pass: ['dot', 'var(--measured)']} as const;

// `runs`: the last one first, as the list has them.
export function stripPlots(runs: readonly RegressionRun[]): Plot[] {
  const ordered = [...runs].reverse();
  const axes = [...new Set(ordered.flatMap(run => (run.parameters ?? []).map(axisName)))];
  return axes.map((axis, i): Plot => {
    const tests = ordered.map((run): ParameterTest | undefined => run.parameters?.find(test => axisName(test) === axis));
    const x = ordered.map((_, j) => j + 1);
    const value = (pick: (test: ParameterTest) => number | null | undefined) => tests.map(test => test ? pick(test) ?? null : null);
    const series = (Object.keys(MARKS) as (keyof typeof MARKS)[]).filter(verdict => ordered.some((run, j) => run.verdict === verdict && tests[j])).map((verdict): Series => ({
      id: verdict, name: verdict, x, y: value(test => test.ratio).map((ratio, j) => ordered[j]!.verdict === verdict ? ratio : null), low: value(test => test.ci[0]), high: value(test => test.ci[1]),
      mark: MARKS[verdict][0], colour: MARKS[verdict][1], noKey: i > 0,
    }));
    // Runs that say nothing of the parameter do not break the margin.
    const known = tests.flatMap((test, j) => test ? [{run: j + 1, limit: test.margin}] : []);
    // That of one run alone has a width, or it could not be seen.
    const told = known.length === 1 ? [-0.5, 0.5].map(half => ({...known[0]!, run: known[0]!.run + half})) : known;
    const limits = told.map(({limit}) => limit);
    const margin: Series = {id: 'margin', name: 'margin', x: told.map(({run}) => run), y: limits, low: limits.map(() => 1), high: limits, band: 'var(--robustband)', line: true, colour: 'var(--robust)', dash: '7 4', width: 1.2, noKey: i > 0};
    const last = i === axes.length - 1;
    const far = Math.max(1.1, ...[...margin.y, ...value(test => test.ratio), ...value(test => test.ci[0]), ...value(test => test.ci[1])].filter(finite).map(ratio => ratio > 1 ? ratio : 1 / ratio));
    const limit = Math.min(far ** 1.15, 8);
    return {id: `axis-${i}`, height: 110, rules: [1], hideX: !last, x: {scale: 'linear', name: 'run', domain: [0.5, Math.max(ordered.length, 4) + 0.5], ticks: x.filter(each => each % Math.ceil(x.length / 12) === 0), write: value => String(value)}, y: {scale: 'log', name: `${axis}: candidate ÷ baseline`, domain: [1 / limit, limit], ticks: limit > 2.2 ? [0.5, 1, 2] : limit > 1.3 ? [0.8, 1, 1.25] : [0.9, 1, 1.1], write: writeTick}, series: [...series, margin]};
  });
}

export function History({title, parameter, runs, path}: {title: string; parameter: string; runs: readonly RegressionRun[]; path: string}): JSX.Element | null {
  const plots = useMemo(() => stripPlots(runs), [runs]);
  if (plots.length === 0) return null;
  const at = (x: number): RegressionRun | undefined => runs[runs.length - Math.round(x)];
  return <Figure name={`regressions-${title}-${parameter}`} title={`${parameterName(parameter)}, ${title}`} sub="95 % of all tests at once" plots={plots} source={`driftlab, ${parameter}`} curl={curlOf(path)}
    describe={`${parameterName(parameter)} of the candidate over that of the baseline in ${runs.length} runs, the last at the right, against the margin of each.`}
    readout={x => <><b>run {Math.round(x)}: {at(x)?.candidate || 'candidate'}, {at(x)?.verdict ?? at(x)?.state}</b>{plots.map(plot => <span key={plot.id}>{defaultReadout(plot, x)}</span>)}</>} />;
}
