"""What can go wrong with what is kept: one root, one class and one stable code for each reason."""

from typing import ClassVar


class CatalogueError(Exception):
    """The root of every error of this package; the message is in plain words."""

    code: ClassVar[str] = "catalogue_error"  # stable; clients may rely on it


class ShapeNotFound(CatalogueError):
    """No shape has this id, or it was removed."""

    code = "not_found"


class DismissalNotFound(CatalogueError):
    """Nobody said that these two shapes are no duplicates."""

    code = "not_dismissed"


class NotAPair(CatalogueError):
    """Two different shapes were needed, and one came twice."""

    code = "not_a_pair"


class FileMissing(CatalogueError):
    """The file store holds nothing under this key."""

    code = "file_missing"


class NotReady(CatalogueError):
    """The shape has no descriptors yet, or never got any."""

    code = "not_ready"


class NotFailed(CatalogueError):
    """Only a shape that failed can be tried again."""

    code = "not_failed"


class BadCursor(CatalogueError):
    """The cursor was not made by this catalogue."""

    code = "bad_cursor"


class UnknownMethod(CatalogueError):
    """No method has this name."""

    code = "unknown_method"


class BadWeights(CatalogueError):
    """Weights that name a block the method lacks, are negative or not finite, or are all zero."""

    code = "bad_weights"


class BadBlock(CatalogueError):
    """A descriptor block is missing, or is not a finite vector of the expected length."""

    code = "bad_block"


class FingerprintMismatch(CatalogueError):
    """Descriptors or vocabularies of different parameters would be mixed."""

    code = "fingerprint_mismatch"


class UnknownVocabulary(CatalogueError):
    """No vocabulary has this id."""

    code = "unknown_vocabulary"


class VocabularyChanged(CatalogueError):
    """Another vocabulary became the active one meanwhile: quantise again, then repeat."""

    code = "vocabulary_changed"


class DescriptionsChanging(CatalogueError):
    """All shapes are being described anew; this can be compared when that is done."""

    code = "descriptions_changing"


class NewerDescriptions(CatalogueError):
    """A newer version of Faience described this library anew; this one must not mix with it."""

    code = "newer_descriptions"


class LeaseLost(CatalogueError):
    """The job is no longer this worker's: its lease ran out and another took it, or its shape is gone."""

    code = "lease_lost"


class StorageFull(CatalogueError):
    """The disk is full; nothing of this write was kept."""

    code = "storage_full"


class CatalogueBusy(CatalogueError):
    """Another process held the database for too long."""

    code = "busy"


class UnknownDatabase(CatalogueError):
    """The address of the catalogue's database names a kind that is not supported."""

    code = "unknown_database"


class StorageUnreachable(CatalogueError):
    """The object storage of the files does not answer, or refuses; later it may not."""

    code = "storage_unreachable"


class UnknownStorage(CatalogueError):
    """The address of the file storage names a kind that is not supported, or a bucket that is not there."""

    code = "unknown_storage"


class NoPgvector(CatalogueError):
    """An index in pgvector is asked for, and the catalogue's database cannot hold one."""

    code = "no_pgvector"


class DamagedIndex(CatalogueError):
    """A saved search index is truncated, altered or of another format."""

    code = "damaged_index"


class BadVocabulary(CatalogueError):
    """Bytes that are no vocabulary, or shapes too few or too alike to learn one from."""

    code = "bad_vocabulary"


class KeyNotFound(CatalogueError):
    """No API key has this id."""

    code = "key_not_found"


class BadKeyName(CatalogueError):
    """The name of an API key is empty, too long or not printable."""

    code = "bad_key_name"


class WebhookNotFound(CatalogueError):
    """No webhook has this id."""

    code = "webhook_not_found"


class BadWebhook(CatalogueError):
    """The address of a webhook is none that can be told anything."""

    code = "bad_webhook"


class ExportRefused(CatalogueError):
    """The root of the reasons why an exported library is not imported; nothing was changed."""

    code = "export_refused"


class DamagedExport(ExportRefused):
    """It is cut, altered, not an export at all, or holds what no library holds."""

    code = "damaged_export"


class NewerFormat(ExportRefused):
    """A newer version of Faience made it."""

    code = "newer_format"


class LibraryNotEmpty(ExportRefused):
    """There are shapes already where it should go."""

    code = "library_not_empty"
