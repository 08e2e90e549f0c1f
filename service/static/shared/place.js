// Where somebody was in the library, for the ways back to it.

let address = "#/";

export const libraryAddress = () => address;

export function rememberLibrary(hash) {
  address = hash;
}
