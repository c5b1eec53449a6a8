// Deleting asks once and names what goes with it.
import type {ComponentChildren, JSX} from 'preact';
import {useRef} from 'preact/hooks';

export function Delete({title, children, onDelete}: {title: string; children: ComponentChildren; onDelete: () => void}): JSX.Element {
  const dialog = useRef<HTMLDialogElement>(null);
  const close = (): void => dialog.current?.close();
  return <>
    <button type="button" class="btn danger" onClick={() => dialog.current?.showModal()}>Delete</button>
    <dialog ref={dialog} aria-label={title}><h2>{title}</h2><p>{children}</p>
      <p class="row"><button type="button" class="btn danger" onClick={() => { close(); onDelete(); }}>Delete</button><button type="button" class="btn" onClick={close}>Keep</button></p></dialog>
  </>;
}
