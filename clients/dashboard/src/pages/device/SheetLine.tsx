// What is measured against what the manufacturer states, where the device's sensor is known.
import type {JSX} from 'preact';
import {writeQuantity} from '../../format/number';
import {writeUnit} from '../../format/words';
import {pageOf} from '../../route';
import {writeStated} from '../datasheet/documents';
import type {SheetComparison} from './documents';

type Figure = SheetComparison['figures'][number];

const WORDS: Record<string, string> = {agrees: 'agrees', above: 'above what is stated', below: 'below what is stated'};

function Compared({figure}: {figure: Figure}): JSX.Element {
  const stated = `${writeStated(figure.stated)} ${writeUnit(figure.unit)}`;
  if (figure.ratio === null) return <>{figure.parameter} is stated as {stated} and not identified here. </>;
  const ratio = writeQuantity({value: figure.ratio, unit: '', ci95: figure.ci95});
  return <>{figure.verdict === 'above' && <span class="g warn" aria-hidden="true">△ </span>}{figure.parameter} is {ratio.value} {ratio.interval} times the {stated} of the data sheet: {WORDS[figure.verdict ?? ''] ?? 'not compared'}. </>;
}

export function SheetLine({comparison}: {comparison: SheetComparison}): JSX.Element {
  return <p class="note"><b>Data sheet:</b> {comparison.figures.map(figure => <Compared key={figure.parameter} figure={figure} />)}<a href={pageOf('data-sheets', comparison.sensor)}>{comparison.sensor}</a>, {comparison.source}; typical figures, {comparison.condition}.</p>;
}
