// The engine for the worker of a page, which bundles it: host_tools/judge/view/web/src/engine/engine_worker.ts.
export { Engine as Client, EngineError as ClientError } from "./engine";
export { default as makeModule } from "engine-module";
