// The density over time against that of the model: what comes and goes. Folded, since few recordings need it.
import type {JSX} from 'preact';
import {useState} from 'preact/hooks';
import {useRead} from '../../api/client';
import type {Channel, ModelFit, Recording, Spectrogram as Document} from '../../api/documents';
import {Tools} from '../../figure/Figure';
import {Spectrogram, ratiosCsv} from '../../figure/Spectrogram';
import {Panel, Shown} from '../../shell/states';
import {save} from '../../figure/export';
import {copy, curlOf} from '../../shell/copy';

export function Leftover({recording, channel, fit, fitId}: {recording: Recording; channel: Channel; fit: ModelFit | undefined; fitId: string | undefined}): JSX.Element {
  const [open, setOpen] = useState(false);
  const path = `/v1/recordings/${recording.id}/spectrogram?channel=${encodeURIComponent(channel.channel)}${fitId ? `&fit=${fitId}` : ''}`;
  const read = useRead<Document>(open ? path : null);
  const name = fit ? `Spectrogram of what ${fit.model} leaves` : 'Spectrogram';
  return <Panel><details data-stays onToggle={event => setOpen(event.currentTarget.open)}>
    <summary><h2>{name}</h2></summary>
    {open && <Shown read={read}>{spectrogram => <>
      <Tools title={name} curl={curlOf(path)} onCsv={() => save(`${recording.id}-${channel.channel}-spectrogram.csv`, 'text/csv', ratiosCsv(spectrogram))} />
      <Spectrogram spectrogram={spectrogram} name={name} />
      <p class="note">The density of each cell over {spectrogram.expected === 'model' ? 'that of the fitted model' : 'the median over time of its frequency'}; full colour is ten times more or less. Even grain is noise that is stationary. <button type="button" class="link" onClick={() => copy(curlOf(path), 'The command is')}>Copy the request</button></p>
    </>}</Shown>}
  </details></Panel>;
}
