// What the pages read is what the contract promises: each document here must be one that the daemon may give.
import type {operations} from './contract';
import type * as documents from './documents';

type Ok<O extends keyof operations> = operations[O] extends {responses: {200: {content: {'application/json': infer Document}}}} ? Document : never;

// Every member that is needed here is a member there.
type Missing<Page, Contract> = Exclude<keyof Page, keyof Contract>;
type None<Names extends never> = Names;

export type Checked = [
  None<Missing<documents.Device, Ok<'getDevice'>>>, None<Missing<documents.DeviceSummary, Ok<'getDeviceSummary'>>>, None<Missing<documents.Recording, Ok<'getRecording'>>>,
  None<Missing<documents.Characterisation, Ok<'getCharacterisation'>>>, None<Missing<documents.CharacterisedChannel, Ok<'getCharacterisation'>['channels'][number]>>,
  None<Missing<documents.Channel, Ok<'getCharacterisation'>['channels'][number]['result']>>, None<Missing<documents.Trace, Ok<'getTrace'>>>, None<Missing<documents.Spectrum, Ok<'getSpectrum'>>>,
  None<Missing<documents.Histogram, Ok<'getHistogram'>>>, None<Missing<documents.Spectrogram, Ok<'getSpectrogram'>>>, None<Missing<documents.Job, Ok<'getJob'>>>,
  None<Missing<documents.Counts, Ok<'getCounts'>>>, None<Missing<documents.Implied, Ok<'getImpliedCurves'>['implied']>>,
];
