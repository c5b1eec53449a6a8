// Lists, forms and documents: pages without figures.
import '../app';
export {EmptyLab} from '../pages/EmptyLab';
export {default as Devices} from '../pages/Devices';
export {default as Investigations} from '../pages/Investigations';
export {default as Outages} from '../pages/Outages';
export {default as Regressions} from '../pages/Regressions';
export {default as Jobs} from '../pages/Jobs';
export {default as Job} from '../pages/Job';
export {default as Upload} from '../pages/Upload';
export {default as Docs} from '../pages/Docs';
export {default as Resource} from '../pages/Resource';
export {default as Webhooks} from '../pages/Webhooks';
export {default as Webhook} from '../pages/Webhook';
export {default as DataSheets} from '../pages/DataSheets';
export {default as DataSheet} from '../pages/DataSheet';
export {default as Populations} from '../pages/Populations';
export {default as Drives} from '../pages/Drives';
export {default as Drive} from '../pages/Drive';
