"""`faience learn-vocabulary`: words that fit the library's own shapes."""

import json as json_format
import time

import typer

from service.commands.failures import CommandFailed, plain_failures
from service.commands.options import DATA_DIR, DataDir, Json


def learn_vocabulary(data_dir: DataDir = DATA_DIR, json: Json = False) -> None:
    """Learn a vocabulary from all shapes of the library and use it from then on.

    Nothing is computed again from the meshes; queries go on being answered with the old vocabulary until
    the new one is complete.
    """
    with plain_failures():
        # heavy; --help must not wait for it
        from index.shapes import Status
        from service.commands.opening import opened, settings_for
        from service.commands.progress import progress_bar
        from service.vocabularies import learn_vocabulary as learn

        start = time.perf_counter()
        with opened(settings_for(data_dir)) as library:
            count = library.catalogue.counts()[Status.READY]
            if count == 0:
                raise CommandFailed(f"the library at {data_dir} is empty; `faience index PATH` fills it")
            with progress_bar("Learning", count) as advance:
                vocabulary = learn(library, lambda done, known: advance(completed=done, total=known))
        seconds = time.perf_counter() - start
    if json:
        fields = {"vocabulary": vocabulary.id, "shapes": count, "seconds": round(seconds, 3)}
        typer.echo(json_format.dumps(fields))
    else:
        typer.echo(f"Learnt {vocabulary.id} from {count} shapes in {seconds:.1f} s; it is in use now.")
