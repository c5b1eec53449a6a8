// Results of the longer jobs.
import '../app';
import './figures';
export {default as Investigation} from '../pages/Investigation';
export {default as Outage} from '../pages/Outage';
export {default as Regressions} from '../pages/Regressions';
export {default as Regression} from '../pages/Regression';
export {default as DriveEvaluation} from '../pages/DriveEvaluation';
