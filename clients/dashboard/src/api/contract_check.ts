// What the pages read is what the contract promises: each document here must be one that the daemon may give.
import type {operations} from './contract';
import type {DataSheetDocument, SensorSheet} from '../pages/datasheet/documents';
import type {StructureDocument} from '../pages/device/documents';
import type {EvaluationRow, StoredDrive} from '../pages/drive/documents';
import type {Investigation, InvestigationRow} from '../pages/investigation/documents';
import type {StoredEvaluation} from '../pages/outage/documents';
import type {PlaceOf, PopulationDocument, PopulationRow} from '../pages/population/documents';
import type {Regression, RegressionRun} from '../pages/regression/documents';
import type {PreviewColumn, PreviewDocument} from '../pages/upload/preview';
import type {Delivery, WebhookDocument} from '../pages/webhook/documents';
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
  None<Missing<documents.Counts, Ok<'getCounts'>>>, None<Missing<documents.Attention, Ok<'listAttention'>['items'][number]>>, None<Missing<documents.Implied, Ok<'getImpliedCurves'>['implied']>>,
  None<Missing<PreviewDocument, Ok<'previewRecording'>>>, None<Missing<PreviewColumn, Ok<'previewRecording'>['columns'][number]>>,
  None<Missing<PopulationDocument, Ok<'getPopulations'>>>, None<Missing<PopulationRow, Ok<'getPopulations'>['rows'][number]>>, None<Missing<PlaceOf, Ok<'getPopulations'>['rows'][number]['places'][number]>>,
  None<Missing<DataSheetDocument, Ok<'listDataSheets'>['items'][number]>>, None<Missing<SensorSheet, Ok<'listDataSheets'>['items'][number]['sensors'][number]>>,
  None<Missing<WebhookDocument, Ok<'getWebhook'>>>, None<Missing<Delivery, Ok<'listDeliveries'>['items'][number]>>, None<Missing<StoredDrive, Ok<'getDrive'>>>, None<Missing<EvaluationRow, Ok<'getDriveEvaluation'>>>,
  None<Missing<Regression, Ok<'getRegression'>>>, None<Missing<RegressionRun, Ok<'listRegressions'>['items'][number]>>, None<Missing<Investigation, Ok<'getInvestigation'>>>,
  None<Missing<InvestigationRow, Ok<'listInvestigations'>['items'][number]>>, None<Missing<StoredEvaluation, Ok<'getOutageEvaluation'>>>, None<Missing<StructureDocument, Ok<'getStructure'>>>,
];
