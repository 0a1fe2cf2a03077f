// In place of the planners' client in pages without planners: nothing of it is called.
export class Client {
  readonly isAlive: boolean = false;
  static create(): Promise<Client> { return Promise.resolve(new Client()); }
  call(): never { throw new ClientError("this page holds no planners"); }
}
export class ClientError extends Error {
  readonly kind = "internal";
  get text(): string { return this.message; }
}
export const makeModule = null;
