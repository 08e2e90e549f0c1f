// What a file is, by its name: the same kinds as the service reads.

const IMAGES = new Set(("png jpg jpeg jpe jfif bmp dib tga tif tiff webp gif jp2 j2k jpx " +
  "ppm pgm pbm pnm dds pcx").split(" "));
const ADDED_BY_SYSTEMS = new Set(["__macosx", "thumbs.db", "desktop.ini"]);

/** The last part of a path. */
export const baseOf = (path) => path.slice(path.lastIndexOf("/") + 1);

/** The folder of a path, "" where there is none. */
export const folderOf = (path) => path.slice(0, Math.max(path.lastIndexOf("/"), 0));

/** What a shape is called after its file: the name without its ending, as the service has it. */
export const stemOf = (path) => baseOf(path).replace(/(?<=.)\.[^.]+$/, "");

/** @returns {"mesh" | "zip" | "material" | "image" | "other"} */
export function kindOf(path) {
  const ending = baseOf(path).toLowerCase().match(/\.([^.]+)$/)?.[1];
  if (ending === "ply" || ending === "obj") return "mesh";
  if (ending === "zip") return "zip";
  if (ending === "mtl") return "material";
  return IMAGES.has(ending) ? "image" : "other";
}

/** Whether a file or a folder of this name is one that systems add by themselves. */
export const isHidden = (name) => name.startsWith(".") || ADDED_BY_SYSTEMS.has(name.toLowerCase());
