"""What keeps a program from other people's eyes and hands (2.1.11): passwords, and the lock behind ten wrong ones."""

from dataclasses import dataclass, field, fields

from .errors import EcsimError

TRIES = 10
LOCKED_US = 5 * 60 * 1_000_000
LONGEST, LONGEST_OF_UNIT = 8, 16


@dataclass
class Passwords:
    """The passwords of upload, download and monitoring, "" for none; `forbid_upload` refuses an upload even with its password."""

    upload: str = ""
    download: str = ""
    monitor: str = ""
    forbid_upload: bool = False

    def check(self) -> None:
        """Raise EcsimError for a password that the machine cannot keep."""
        for kind in KINDS:
            _check(f"the {kind} password", getattr(self, kind), LONGEST, empty=True)
        if not isinstance(self.forbid_upload, bool):
            raise EcsimError(f"forbid_upload is {self.forbid_upload!r}; write True or False")


KINDS = tuple(field.name for field in fields(Passwords) if field.type is str)


def check_unit_password(unit: str, password: str) -> None:
    """Raise EcsimError for a password that cannot close a unit."""
    _check(f"the password of {unit}", password, LONGEST_OF_UNIT, empty=False)


def _check(what: str, password: str, longest: int, empty: bool) -> None:
    sound = isinstance(password, str) and len(password) <= longest and password.isascii() and (password.isalnum() or not password)
    if not sound or not (password or empty):
        raise EcsimError(f"{what} cannot be {password!r:.40}; take up to {longest} letters and digits (2.1.11)")


@dataclass
class Protection:
    """The passwords in a machine, which of them have been given, and how many wrong ones in a row."""

    passwords: Passwords = field(default_factory=Passwords)
    given: set[str] = field(default_factory=set)
    wrong: int = 0
    locked_until_us: int = 0

    def download(self, passwords: Passwords) -> None:
        """New passwords: those that were given before count no longer."""
        self.passwords, self.given = passwords, set()

    def enter(self, what: str, right: str, password: str, now_us: int) -> None:
        """Take a password for `what`; raises EcsimError for a wrong one, and for any while the entry is locked."""
        if self.locked_until_us - LOCKED_US <= now_us < self.locked_until_us:  # before that only where a step back has led
            left = -(-(self.locked_until_us - now_us) // 1_000_000)
            raise EcsimError(
                f"no password is taken for another {left} s of simulated time: {TRIES} wrong ones were given in a row (2.1.11)"
            )
        if password != right:
            self.wrong += 1
            if self.wrong == TRIES:
                self.wrong, self.locked_until_us = 0, now_us + LOCKED_US
                raise EcsimError(f"this is not the password of {what}; {TRIES} wrong ones lock the entry for 5 minutes (2.1.11)")
            raise EcsimError(f"this is not the password of {what}; upper and lower case count, {TRIES - self.wrong} more tries (2.1.11)")
        self.wrong = 0
        self.given.add(what)

    def demand(self, kind: str) -> None:
        """Raise EcsimError unless something may be done: its password was given, or there is none."""
        if getattr(self.passwords, kind) and kind not in self.given:
            raise EcsimError(f"the {kind} is closed by a password; give it with unlock({kind!r}, password) (2.1.11)")
