// What the candidate is becomes what later runs are compared with; the daemon keeps why.
import type {JSX} from 'preact';
import {useRef, useState} from 'preact/hooks';
import {type Problem, send} from '../../api/client';
import {say} from '../../shell/say';
import {Refusal} from '../../shell/states';

export function Accept({device, label}: {device: string; label: string}): JSX.Element {
  const dialog = useRef<HTMLDialogElement>(null);
  const [reason, setReason] = useState('');
  const [problem, setProblem] = useState<Problem>();
  const close = (): void => dialog.current?.close();
  // What is refused stays typed.
  const accept = (event: Event): void => {
    event.preventDefault();
    setProblem(undefined);
    send('POST', '/v1/regression-anchors', {device, label, reason}).then(() => { setReason(''); close(); say(`${label} is the baseline of ${device} now.`); }, error => setProblem(error as Problem));
  };
  return <>
    <button type="button" class="btn" onClick={() => dialog.current?.showModal()}>Accept as new baseline</button>
    <dialog ref={dialog} aria-label="Accept as new baseline"><h2>Accept {label} as the new baseline?</h2>
      <form onSubmit={accept}><p>Later runs of {device} that name no baseline are compared with it.</p>
        <label>Reason <input type="text" required value={reason} onInput={event => setReason(event.currentTarget.value)} /></label>
        {problem && <Refusal problem={problem} />}
        <p class="row"><button type="submit" class="btn primary">Accept</button><button type="button" class="btn" onClick={close}>Leave it as it is</button></p></form></dialog>
  </>;
}
