// What became of a job that has ended, step by step: its stream of events then ends too.
import type {JSX} from 'preact';
import {useEffect, useState} from 'preact/hooks';
import {ask} from '../../api/client';
import {writeClock} from '../../format/time';
import {Panel} from '../../shell/states';

interface Step { state: string; stage: string | null; attempt: number; at: string }

const MOST = 40;  // the last ones: runs of a simulation have each a stage of their own

// Progress within a stage is no step.
function stepsIn(text: string): Step[] {
  const all = [...text.matchAll(/^data: (.*)$/gm)].map(([, data]) => JSON.parse(data!) as Step);
  return all.filter((step, i) => i === 0 || step.state !== all[i - 1]!.state || step.stage !== all[i - 1]!.stage);
}

export function Events({job}: {job: string}): JSX.Element | null {
  const [steps, setSteps] = useState<Step[]>([]);
  useEffect(() => { ask(`/v1/jobs/${job}/events`).then(answer => answer.text()).then(text => setSteps(stepsIn(text)), () => undefined); }, [job]);
  if (steps.length === 0) return null;
  return <Panel title="Events" sub={steps.length > MOST ? `the last ${MOST} of ${steps.length}` : ''}><table class="stacked"><thead><tr><th scope="col">when, UTC</th><th scope="col">state</th><th scope="col">stage</th><th scope="col" class="n">attempt</th></tr></thead>
    <tbody>{steps.slice(-MOST).map((step, i) => <tr key={i}><th scope="row">{writeClock(step.at)}</th><td>{step.state}</td><td class="sec">{step.stage ?? '–'}</td><td class="n" data-label="attempt">{step.attempt}</td></tr>)}</tbody></table></Panel>;
}
