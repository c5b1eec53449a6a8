// What was measured: devices, their recordings, populations.
import '../app';
import './figures';
export {default as Device} from '../pages/Device';
export {default as Recording} from '../pages/Recording';
export {default as Compare} from '../pages/Compare';
export {default as Population} from '../pages/Population';
