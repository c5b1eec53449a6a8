// One receiver: what it hears of, what it was told, and how that went.
import type {JSX} from 'preact';
import {useEffect, useState} from 'preact/hooks';
import {Problem, remove, send, useRead} from '../api/client';
import type {List} from '../api/documents';
import {writeClock, writeFull, writeWhen} from '../format/time';
import {capital, plural} from '../format/words';
import {choose, go, here, listOf, pageOf, usePlace} from '../route';
import {Delete} from '../shell/Delete';
import {Head} from '../shell/Head';
import {copy, curlOf} from '../shell/copy';
import {say} from '../shell/say';
import {Pager} from '../shell/Pager';
import {Panel, Refusal, Segments, Shown} from '../shell/states';
import {useTitle} from '../shell/title';
import {hears, isPaused, receiverOf, type Delivery, type Issued, type WebhookDocument} from './webhook/documents';
import {Secret} from './webhook/Secret';

const WAITS_MS = 1000;
const STATES: Record<Delivery['state'], [string, string, string]> = {waiting: ['○', '', 'waits'], delivered: ['✓', 'good', 'arrived'], given_up: ['✗', 'bad', 'given up']};

// Attempts are no events of the lab: while a message waits, the list asks by itself. `asked` counts what was sent from this page.
function Deliveries({hook, asked}: {hook: WebhookDocument; asked: number}): JSX.Element {
  const {query} = usePlace();
  const state = query.get('state') ?? 'all';
  const after = query.get('after');
  const path = `/v1/webhooks/${hook.id}/deliveries?sort=-created_at&limit=50${state === 'all' ? '' : `&state=${state}`}${after ? `&cursor=${after}` : ''}`;
  const read = useRead<List<Delivery>>(path, WAITS_MS);
  const waits = read.data?.items.some(each => each.state === 'waiting') ?? false;
  useEffect(() => { if (asked > 0) read.again(); }, [asked]);
  useEffect(() => {
    if (!waits) return undefined;
    const timer = setInterval(read.again, WAITS_MS);
    return () => clearInterval(timer);
  }, [waits, path]);
  return <Panel title="Deliveries" sub="newest first" controls={<Segments label="State" options={[['all', 'All'], ['waiting', 'Waiting'], ['delivered', 'Arrived'], ['given_up', 'Given up']] as const} value={state as 'all'} onChange={value => choose({state: value === 'all' ? null : value, after: null})} />}
    tools={<div class="tools"><button type="button" class="quiet" onClick={() => copy(curlOf(path), 'The command is')}>curl</button></div>}>
    <Shown read={read}>{list => list.items.length === 0 ? <p class="sec">{state === 'all' ? 'Nothing was told yet. A message to try it with goes out at once.' : 'None in this state.'}</p> : <>
      <div class="scroll"><table class="stacked">
        <thead><tr><th scope="col">message</th><th scope="col">job</th><th scope="col">state</th><th scope="col" class="n">attempts</th><th scope="col">answer</th><th scope="col">when</th><th scope="col"><span class="visually-hidden">Content</span></th></tr></thead>
        <tbody>{list.items.map(each => { const [mark, tone, word] = STATES[each.state]; return <tr key={each.id}>
          <th scope="row">{each.type}</th><td>{each.job ? <a href={pageOf('jobs', each.job)}>{each.job.slice(0, 8)}…{each.job.slice(-4)}</a> : '–'}</td>
          <td class="nowrap"><span class={`g ${tone}`} aria-hidden="true">{mark} </span>{word}{each.next_attempt_at ? `, again at ${writeClock(each.next_attempt_at)}` : ''}</td><td class="n" data-label="attempts">{each.attempts}</td>
          <td class="sec">{each.last_error ?? (each.last_status === null ? '–' : String(each.last_status))}</td><td class="sec nowrap" title={writeFull(each.created_at)}>{writeWhen(each.created_at)}</td>
          <td class="n"><button type="button" class="link touch" onClick={() => copy(JSON.stringify(each.message, null, 2), 'The message is')}>Copy<span class="visually-hidden"> the message {each.id}</span></button></td></tr>; })}</tbody></table></div>
      <Pager next={list.next_cursor} /></>}</Shown>
  </Panel>;
}

function Body({hook, again}: {hook: WebhookDocument; again: () => void}): JSX.Element {
  const [problem, setProblem] = useState<Problem>();
  const [secret, setSecret] = useState('');
  const [asked, setAsked] = useState(0);
  const refused = (error: unknown): void => setProblem(error as Problem);
  const enable = (enabled: boolean): void => { setProblem(undefined); send('PATCH', `/v1/webhooks/${hook.id}`, {enabled}, {'If-Match': '*'}).then(again, refused); };
  const test = (): void => { setProblem(undefined); send('POST', `/v1/webhooks/${hook.id}/test`).then(() => { say('A message is under way.'); if (here().query.has('state') || here().query.has('after')) choose({state: null, after: null}); setAsked(asked + 1); }, refused); };
  const rotate = (): void => { setProblem(undefined); send<Issued>('POST', `/v1/webhooks/${hook.id}/rotate`).then(issued => { setSecret(issued.secret); again(); }, refused); };
  const forget = (): void => { remove(`/v1/webhooks/${hook.id}`).then(() => { say('The webhook is deleted.'); go(listOf('webhooks')); }, refused); };
  return <>
    <Head crumb={[['Webhooks', listOf('webhooks')], [receiverOf(hook.url), null]]} title={hook.description || receiverOf(hook.url)} facts={[<code>{hook.url}</code>, `since ${writeWhen(hook.created_at)}`]}
      actions={<>{hook.enabled ? <><button type="button" class="btn" onClick={test}>Send a test</button><button type="button" class="btn" onClick={() => enable(false)}>Pause</button></> : <button type="button" class="btn primary" onClick={() => enable(true)}>Enable again</button>}
        <button type="button" class="btn" onClick={rotate}>New secret</button><Delete title="Delete this webhook?" onDelete={forget}>{receiverOf(hook.url)} hears nothing more; its deliveries and what waits go with it.</Delete></>} />
    <p class="verdict" role="status">{hook.enabled ? hook.given_up > 0 ? <><span class="g warn" aria-hidden="true">△ </span>{capital(plural(hook.given_up, 'delivery', 'deliveries'))} in a row did not arrive; after three the webhook is disabled.</> : `It hears of ${hears(hook)}.`
      : isPaused(hook) ? 'Paused: nothing is told, and what waited was given up.' : <><span class="g bad" aria-hidden="true">✗ </span>{hook.disabled_why}</>}
      {hook.previous_secret_until && <small>The secret before signs beside the new one until {writeFull(hook.previous_secret_until)}.</small>}</p>
    {problem && <Refusal problem={problem} />}
    {secret && <Secret secret={secret} onSeen={() => setSecret('')} />}
    <Deliveries hook={hook} asked={asked} />
  </>;
}

export default function Webhook(): JSX.Element {
  const {parts} = usePlace();
  const read = useRead<WebhookDocument>(`/v1/webhooks/${encodeURIComponent(parts[1] ?? '')}`, 5000);
  useTitle('Webhook');
  return <Shown read={read} page="Webhook">{hook => <Body hook={hook} again={read.again} />}</Shown>;
}
