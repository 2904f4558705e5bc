"""The filter of system calls in the sandbox, made by libseccomp.

It rejects calls that a derivation does not need and that are dangerous: memory that no limit counts (in files without
a name, in pages that a pipe holds, in attributes and locks of files), sockets, keys, namespaces, mounts, other
processes, and interfaces of the kernel with a history of faults.
"""

import ctypes
import os
import tempfile
from functools import cache

REFUSED = """
    vmsplice setxattr lsetxattr fsetxattr setxattrat io_setup
    memfd_create memfd_secret shmget shmat shmctl msgget semget mq_open socket socketpair add_key keyctl request_key
    unshare setns mount umount2 pivot_root chroot open_tree move_mount fsopen fsconfig fsmount fspick mount_setattr
    ptrace process_vm_readv process_vm_writev process_madvise pidfd_getfd kcmp perf_event_open bpf userfaultfd
    io_uring_setup io_uring_enter io_uring_register fanotify_init name_to_handle_at open_by_handle_at syslog acct
    quotactl swapon swapoff reboot kexec_load kexec_file_load init_module finit_module delete_module settimeofday
    clock_settime clock_adjtime adjtimex sethostname setdomainname iopl ioperm move_pages mbind set_mempolicy
    migrate_pages lookup_dcookie uselib vhangup
"""
EPERM, ENOSYS = 1, 38
NAMESPACES = (0x20000, *(0x2000000 << n for n in range(6)))  # flags of clone that make one
TERMINAL_INPUT = (0x5412, 0x541C)  # ioctls TIOCSTI and TIOCLINUX
FILE_LOCKS = (6, 7, 37, 38)  # commands F_SETLK, F_SETLKW, F_OFD_SETLK and F_OFD_SETLKW of fcntl
ALLOW, REFUSE, MASKED_EQUAL = 0x7FFF0000, 0x00050000, 7  # of seccomp.h


class _Condition(ctypes.Structure):
    """Struct scmp_arg_cmp: a masked argument, by its number, equals a value."""

    _fields_ = (
        ("argument", ctypes.c_uint),
        ("operator", ctypes.c_int),
        ("mask", ctypes.c_uint64),
        ("value", ctypes.c_uint64),
    )


@cache
def call_filter() -> bytes:
    """Return the filter as a program of the kernel.

    Returns
    -------
    bytes
        Empty if libseccomp is not installed.
    """
    try:
        library = ctypes.CDLL("libseccomp.so.2")
    except OSError:
        return b""
    library.seccomp_init.restype = ctypes.c_void_p
    rules = ctypes.c_void_p(library.seccomp_init(ALLOW))
    for name in REFUSED.split():
        _reject(library, rules, name, EPERM)
    _reject(library, rules, "clone3", ENOSYS)  # its flags lie in memory; programs take clone then
    for flag in NAMESPACES:
        _reject(library, rules, "clone", EPERM, _Condition(0, MASKED_EQUAL, flag, flag))
    for call, requests in (("ioctl", TERMINAL_INPUT), ("fcntl", FILE_LOCKS)):
        for request in requests:
            _reject(library, rules, call, EPERM, _Condition(1, MASKED_EQUAL, 0xFFFFFFFF, request))
    try:
        return _exported(library, rules)
    finally:
        library.seccomp_release(rules)


def _reject(library: ctypes.CDLL, rules: ctypes.c_void_p, name: str, errno: int, *condition: _Condition) -> None:
    number = library.seccomp_syscall_resolve_name(name.encode())
    if number < 0:  # this machine or this version of the library has no such call
        return
    conditions = (_Condition * len(condition))(*condition)
    failed = library.seccomp_rule_add_array(rules, REFUSE | errno, number, len(condition), conditions)
    if failed:
        raise OSError(-failed, f"libseccomp: {os.strerror(-failed)}", name)


def _exported(library: ctypes.CDLL, rules: ctypes.c_void_p) -> bytes:
    with tempfile.TemporaryFile() as file:
        if failed := library.seccomp_export_bpf(rules, file.fileno()):
            raise OSError(-failed, f"libseccomp: {os.strerror(-failed)}")
        file.seek(0)
        return file.read()
