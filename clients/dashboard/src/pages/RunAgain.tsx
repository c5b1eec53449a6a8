// The form that asks for a job's work with other settings, filled with those that it had. Its fields are those of the contract.
import type {JSX} from 'preact';
import {useState} from 'preact/hooks';
import {Problem, send, useRead} from '../api/client';
import type {Job} from '../api/documents';
import {capital, jobKind, spaced} from '../format/words';
import {go, pageOf, usePlace} from '../route';
import {Head} from '../shell/Head';
import {Panel, Refusal, Shown} from '../shell/states';
import {useTitle} from '../shell/title';
import {what} from './Jobs';
import {asked, type Asked} from './job/asked';

interface Property { type?: string; enum?: (string | number)[]; items?: {type?: string; enum?: string[]}; oneOf?: Property[]; minimum?: number; maximum?: number; default?: unknown; description?: string; $ref?: string; properties?: Record<string, Property> }
interface Contract { $defs: Record<string, Property> }

// How a setting is typed: a choice, a tick, a number, words with commas between them, or JSON where it is none of these.
type Way = 'choice' | 'tick' | 'number' | 'words' | 'json';
function wayOf({type, enum: choices, items}: Property): Way {
  if (choices) return 'choice';
  if (type === 'boolean') return 'tick';
  if (type === 'number' || type === 'integer') return 'number';
  return type === 'array' && (items?.type === 'string' || items?.enum) ? 'words' : 'json';
}

const typed = (value: unknown, way: Way): string => value === undefined || value === null ? '' : way === 'json' ? JSON.stringify(value).replace(/([,:])(?=["\[{])/g, '$1 ') : way === 'words' ? (value as string[]).join(', ') : String(value);

function meant(text: string, {enum: choices}: Property, way: Way): unknown {
  if (way === 'tick') return text === 'true';
  if (text.trim() === '') return undefined;
  if (way === 'choice') return choices!.find(each => String(each) === text);
  return way === 'number' ? Number(text) : way === 'words' ? text.split(',').map(word => word.trim()).filter(Boolean) : JSON.parse(text) as unknown;
}

// The settings of a kind of job as the contract has them; of a simulation of outages its scenario too, which may be a name or a document.
function settingsOf({$defs}: Contract, {kind, inputs}: Asked): Record<string, Property> {
  const of = $defs[kind]?.properties ?? {};
  const parameters = of.parameters?.$ref ? $defs[of.parameters.$ref.split('/').pop()!] : of.parameters;
  const scenario = of.inputs?.properties?.scenario?.oneOf?.find(each => each.enum);
  return {...(scenario ? {scenario: typeof inputs.scenario === 'string' ? scenario : {}} : {}), ...parameters?.properties};
}

function Field({name, property, value, onChange}: {name: string; property: Property; value: string; onChange: (value: string) => void}): JSX.Element {
  const way = wayOf(property);
  const about = property.description ? `about-${name}` : undefined;
  const common = {id: `set-${name}`, 'aria-describedby': about};
  const take = (event: JSX.TargetedEvent<HTMLInputElement | HTMLSelectElement | HTMLTextAreaElement>): void => onChange(event.currentTarget.value);
  return <div class="setting"><label for={`set-${name}`}>{spaced(name)}</label>
    {way === 'choice' ? <select {...common} value={value} onChange={take}>{property.enum!.map(each => <option key={each} value={each}>{typeof each === 'string' ? spaced(each) : each}</option>)}</select>
      : way === 'tick' ? <input type="checkbox" {...common} checked={value === 'true'} onChange={event => onChange(String(event.currentTarget.checked))} />
      : way === 'number' ? <input type="number" step="any" min={property.minimum} max={property.maximum} {...common} value={value} onInput={take} />
      : way === 'words' ? <input type="text" {...common} value={value} onInput={take} />
      : <textarea rows={Math.min(6, 1 + Math.ceil(value.length / 40))} {...common} value={value} onInput={take} />}
    {about && <span class="u" id={about}>{property.description!.replace(/`/g, '')}</span>}</div>;
}

function Form({job, contract}: {job: Job; contract: Contract}): JSX.Element {
  const former = asked(job);
  const settings = settingsOf(contract, former);
  const had = {...former.inputs.scenario ? {scenario: former.inputs.scenario} : {}, ...former.parameters};
  const names = Object.keys(settings);
  const [texts, setTexts] = useState<Record<string, string>>(() => Object.fromEntries(names.map(name => [name, typed(had[name as keyof typeof had] ?? settings[name]!.default, wayOf(settings[name]!))])));
  const [problem, setProblem] = useState<Problem>();
  // What is as it would be anyway is not sent: some questions take no word of it. A regression would take that of its anchor instead.
  const sent = (name: string, value: unknown): boolean => value !== undefined && (job.kind === 'regress' || JSON.stringify(value) !== JSON.stringify(settings[name]!.default ?? (wayOf(settings[name]!) === 'tick' ? false : null)));
  const start = (event: Event): void => {
    event.preventDefault();
    setProblem(undefined);
    let values: [string, unknown][] = [];
    for (const name of names) {
      try { values.push([name, meant(texts[name]!, settings[name]!, wayOf(settings[name]!))]); } catch { setProblem(new Problem({type: '', title: '', status: 0, detail: `${capital(spaced(name))} is no JSON.`})); return; }
    }
    const scenario = values.find(([name]) => name === 'scenario')?.[1];
    values = values.filter(([name, value]) => name !== 'scenario' && sent(name, value));
    // What is refused stays typed.
    send<Job>('POST', '/v1/jobs', {kind: job.kind, inputs: scenario === undefined ? former.inputs : {...former.inputs, scenario}, parameters: Object.fromEntries(values)})
      .then(made => go(pageOf('jobs', made.id)), error => setProblem(error as Problem));
  };
  return <form onSubmit={start}><Panel title="Settings" sub="filled with those of the job">
    {names.map(name => <Field key={name} name={name} property={settings[name]!} value={texts[name]!} onChange={text => setTexts({...texts, [name]: text})} />)}
    {problem && <Refusal problem={problem} />}
    <p class="row"><button type="submit" class="btn primary">Run</button><span class="note">The former result stays. The same settings lead to it.</span></p>
  </Panel></form>;
}

export default function RunAgain(): JSX.Element {
  const like = usePlace().query.get('like') ?? '';
  const job = useRead<Job>(`/v1/jobs/${encodeURIComponent(like)}`);
  const contract = useRead<Contract>('/schemas/job-request.schema.json');
  useTitle('Run again');
  return <Shown read={job} page="Run again">{former => <>
    <Head crumb={[['Jobs', '/jobs'], [former.id, pageOf('jobs', former.id)], ['again', null]]} title={`Run again: ${jobKind(former.kind)}`} facts={[what(former)]} />
    <Shown read={contract}>{found => <Form job={former} contract={found} />}</Shown>
  </>}</Shown>;
}
