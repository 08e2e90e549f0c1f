"""What the service said it did: the promises that a crash must not break."""

import random
import threading
from collections import Counter
from dataclasses import dataclass, field


@dataclass
class Ledger:
    """Kept by several clients at once; what got no answer may have happened or not."""

    acknowledged: dict[str, int] = field(default_factory=dict)  # id → number of its parcel, told by a 2xx
    removing: set[str] = field(default_factory=set)  # ids whose removal was asked for
    removed: set[str] = field(default_factory=set)  # ids whose removal was told
    unanswered: set[int] = field(default_factory=set)  # numbers of parcels sent without an answer
    answers: Counter[str] = field(default_factory=Counter)  # "what status" → how often
    surprises: list[str] = field(default_factory=list)  # what should not have been answered
    _lock: threading.Lock = field(default_factory=threading.Lock)
    _next: int = 0

    def next_number(self) -> int:
        """Return the number of a parcel that nobody has sent yet."""
        with self._lock:
            self._next += 1
            return self._next

    def again(self, random: random.Random) -> int | None:
        """Return a parcel that got no answer, to be sent once more; None where there is none."""
        with self._lock:
            return random.choice(sorted(self.unanswered)) if self.unanswered else None

    def acknowledge(self, shape_id: str, number: int) -> None:
        """Note that an upload was told to be kept."""
        with self._lock:
            self.unanswered.discard(number)
            earlier = self.acknowledged.setdefault(shape_id, number)
            if earlier != number:
                self.surprises.append(f"parcels {earlier} and {number} were told to be one shape, {shape_id}")

    def note(self, what: str, status: int | None, expected: frozenset[int], detail: str = "") -> None:
        """Count an answer; remember one that is not as it should be. None: there was no answer."""
        with self._lock:
            self.answers[f"{what} {status or 'cut'}"] += 1
            if status is not None and status not in expected:
                self.surprises.append(f"{what} was answered with {status}: {detail[:300]}")

    def unanswer(self, number: int) -> None:
        """Note that a parcel was sent and nothing came back."""
        with self._lock:
            self.unanswered.add(number)

    def pick(self, random: random.Random) -> str | None:
        """Return an acknowledged shape whose removal nobody asked for; None where there is none."""
        with self._lock:
            standing = sorted(self.acknowledged.keys() - self.removing)
        return random.choice(standing) if standing else None

    def remove(self, shape_id: str, *, told: bool) -> None:
        """Note that a removal was asked for, and whether it was told."""
        with self._lock:
            self.removing.add(shape_id)
            if told:
                self.removed.add(shape_id)

    def standing(self) -> dict[str, int]:
        """Return what must be there: told to be kept, its removal never asked for."""
        with self._lock:
            return {id_: number for id_, number in self.acknowledged.items() if id_ not in self.removing}
