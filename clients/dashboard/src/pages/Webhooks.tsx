// Who is told when jobs end, and the form that adds a receiver.
import type {JSX} from 'preact';
import {useState} from 'preact/hooks';
import {Problem, send, useRead} from '../api/client';
import type {List} from '../api/documents';
import {writeWhen} from '../format/time';
import {pageOf, usePlace} from '../route';
import {Head} from '../shell/Head';
import {Pager} from '../shell/Pager';
import {Panel, Refusal, Shown} from '../shell/states';
import {Tabs} from '../shell/Tabs';
import {useTitle} from '../shell/title';
import {EVENTS, EVENT_WORDS, hears, isPaused, receiverOf, type EventType, type Issued, type WebhookDocument} from './webhook/documents';
import {Secret} from './webhook/Secret';

function Add({onMade}: {onMade: (made: Issued) => void}): JSX.Element {
  const [url, setUrl] = useState('');
  const [description, setDescription] = useState('');
  const [events, setEvents] = useState<EventType[]>([...EVENTS]);
  const [problem, setProblem] = useState<Problem>();
  const [busy, setBusy] = useState(false);
  const toggle = (event: EventType): void => setEvents(EVENTS.filter(each => (each === event) !== events.includes(each)));
  const add = (event: Event): void => {
    event.preventDefault();
    setBusy(true);
    setProblem(undefined);
    send<Issued>('POST', '/v1/webhooks', {url: url.trim(), ...(description.trim() ? {description: description.trim()} : {}), events}).then(made => {
      setUrl('');
      setDescription('');
      setEvents([...EVENTS]);
      onMade(made);
    }, error => setProblem(error as Problem)).finally(() => setBusy(false));
  };
  return <Panel title="Add a receiver" sub="it is told when jobs end, so that a pipeline need not ask again and again">
    <form onSubmit={add}>
      <div class="row"><label>address <input type="text" inputMode="url" required placeholder="https://ci.example.org/driftlab" value={url} class="wide" onInput={event => setUrl(event.currentTarget.value)} /></label>
        <label>for whom <input type="text" placeholder="firmware pipeline" value={description} onInput={event => setDescription(event.currentTarget.value)} /></label></div>
      <fieldset class="row plain"><legend class="visually-hidden">hears of</legend><span aria-hidden="true">hears of</span>{EVENTS.map(event => <label key={event}><input type="checkbox" checked={events.includes(event)} onChange={() => toggle(event)} /> {EVENT_WORDS[event]}</label>)}
        <button type="submit" class="btn primary" disabled={busy || events.length === 0}>Add</button></fieldset>
      {problem && <Refusal problem={problem} />}
    </form>
    <p class="note">Addresses of the Internet by https; a receiver in your own network is named when the daemon starts, by <code>--webhook-allow</code>. <a href="/docs/webhooks">The manual</a></p>
  </Panel>;
}

export function State({hook}: {hook: WebhookDocument}): JSX.Element {
  if (hook.enabled) return <>{hook.given_up > 0 ? <><span class="g warn" aria-hidden="true">△ </span>{hook.given_up} given up in a row</> : <><span class="g good" aria-hidden="true">✓ </span>enabled</>}</>;
  return isPaused(hook) ? <span class="sec">paused</span> : <><span class="g bad" aria-hidden="true">✗ </span>{hook.disabled_why}</>;
}

export default function Webhooks(): JSX.Element {
  const {query} = usePlace();
  useTitle('Webhooks');
  const after = query.get('after');
  const read = useRead<List<WebhookDocument>>(`/v1/webhooks?sort=-created_at&limit=50${after ? `&cursor=${after}` : ''}`, 5000);
  const [made, setMade] = useState<Issued>();
  return <>
    <Head title="Webhooks" facts={['who is told when jobs end']} />
    <Tabs group="jobs" />
    {made && <Secret secret={made.secret} onSeen={() => setMade(undefined)} />}
    {read.problem?.document.status !== 403 && <Add onMade={each => { setMade(each); read.again(); }} />}
    <Panel title="Receivers" sub="newest first"><Shown read={read}>{list => list.items.length === 0 ? <p class="sec">None yet.</p> : <>
      <div class="scroll"><table class="stacked">
        <thead><tr><th scope="col">receiver</th><th scope="col">for whom</th><th scope="col">hears of</th><th scope="col">state</th><th scope="col">since</th></tr></thead>
        <tbody>{list.items.map(hook => <tr key={hook.id}><th scope="row"><a href={pageOf('webhooks', hook.id)}>{receiverOf(hook.url)}</a></th><td class="sec">{hook.description || '–'}</td><td class="sec">{hears(hook)}</td><td><State hook={hook} /></td><td class="sec nowrap">{writeWhen(hook.created_at)}</td></tr>)}</tbody></table></div>
      <Pager next={list.next_cursor} /></>}</Shown></Panel>
  </>;
}
