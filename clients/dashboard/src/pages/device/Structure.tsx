// Whether one structure serves every condition: which candidates are best where, and how far behind they are over all. The verdict above says it in a sentence.
import type {JSX} from 'preact';
import {writeNumber, writeP} from '../../format/number';
import {conditionName, plural} from '../../format/words';
import {finite} from '../../figure/spec';
import {Panel} from '../../shell/states';
import type {ParameterTable} from './documents';

const WORDS = {one_structure: 'one structure', changes: 'it changes with the condition', undecided: 'undecided'};

export function Structure({table}: {table: ParameterTable}): JSX.Element | null {
  const {structure} = table;
  if (!structure || structure.by_condition.length < 2) return null;
  const nameOf = (label: string): string => { const row = table.rows.find(each => each.label === label); return row ? conditionName(row.condition, table.axis) : label; };
  const best = (model: string): string => structure.by_condition.filter(one => one.model === model).map(one => nameOf(one.label)).join(', ');
  const [first] = structure.ranking;
  const shown = structure.ranking.filter(({model}) => model === first?.model || model === structure.common || best(model));
  const rest = structure.ranking.length - shown.length;
  return <Panel title="One structure or several" sub={`${WORDS[structure.verdict]}${structure.p === null || !structure.dof || structure.verdict === 'changes' ? '' : `, ${writeP(structure.p)}`}`}>
    <table class="stacked"><thead><tr><th scope="col">structure</th><th scope="col">best under</th><th scope="col" class="n">criterion over all</th></tr></thead>
      <tbody>{shown.map(({model, criterion}) => <tr key={model}><th scope="row">{model}{model === structure.common && <span class="u"> serves all</span>}</th><td class="sec">{best(model) || 'no condition'}</td>
        <td class="n u" data-label="criterion over all">{model === first?.model ? 'best' : finite(criterion) && finite(first?.criterion) ? `+${writeNumber(criterion - first.criterion, 2)}` : '–'}</td></tr>)}</tbody></table>
    {rest > 0 && <p class="note">{plural(rest, 'other candidate is', 'other candidates are')} best under no condition.</p>}
  </Panel>;
}
