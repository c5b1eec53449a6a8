// What was asked of drives, newest first.
import type {JSX} from 'preact';
import {writeWhen} from '../../format/time';
import {capital} from '../../format/words';
import {pageOf} from '../../route';
import {SHORT, type EvaluationRow} from './documents';

export function Evaluations({rows, named}: {rows: readonly EvaluationRow[]; named: boolean}): JSX.Element {
  return <div class="scroll"><table class="stacked">
    <thead><tr><th scope="col">asked</th>{named && <th scope="col">drive</th>}<th scope="col">state</th><th scope="col">when</th></tr></thead>
    <tbody>{rows.map(row => <tr key={row.id}><th scope="row"><a href={pageOf('drive-evaluations', row.id)}>{capital(SHORT[row.question])}</a></th>{named && <td><a href={pageOf('drives', row.drive)}>{row.name}</a></td>}
      <td>{row.problem ? <><span class="g bad" aria-hidden="true">✗ </span>{row.problem.detail}</> : `${row.state}${row.finished_at ? '' : `, ${Math.round(row.progress * 100)} %`}`}</td><td class="sec nowrap">{writeWhen(row.created_at)}</td></tr>)}</tbody></table></div>;
}
