# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Prints as JSON what the library of Exodus II reads from Nemesis pieces.

It is a separate program because the library uses another libnetcdf than Python's module.
"""
import ctypes
import json
import sys

exodus = ctypes.CDLL("libexoIIv2c.so.5")
VERSION = 602  # of the header that this program follows


def check(status):
    if status != 0:
        sys.exit(f"the library of Exodus II returns {status}")


def numbers(count):
    return (ctypes.c_int * max(count, 1))()


def read(path):
    words, version = [ctypes.c_int(8), ctypes.c_int(0)], ctypes.c_float()
    exodus.ex_opts(1)  # prints its errors
    file = exodus.ex_open_int(path.encode(), 0, *map(ctypes.byref, words), ctypes.byref(version), VERSION)
    if file < 0:
        sys.exit("the library of Exodus II does not open it")

    def counts(call, count, *last):
        found = [ctypes.c_int(-1) for _ in range(count)]
        check(call(file, *map(ctypes.byref, found), *last))
        return [number.value for number in found]

    def lists(call, sizes, *ids):
        found = [numbers(size) for size in sizes]
        check(call(file, *ids, *found))
        return [list(values)[:size] for values, size in zip(found, sizes)]

    kind = ctypes.create_string_buffer(2)
    processors, in_file = counts(exodus.ex_get_init_info, 2, kind)
    whole = counts(exodus.ex_get_init_global, 5)
    load = counts(exodus.ex_get_loadbal_param, 7, 0)
    maps = lists(lambda f, *found: exodus.ex_get_cmap_params(f, *found, 0), [load[5], load[5], load[6], load[6]])
    result = {
        "processors": processors, "in file": in_file, "kind": kind.value.decode(), "whole": whole, "load": load,
        "nodes": lists(lambda f, *found: exodus.ex_get_processor_node_maps(f, *found, 0), load[:3]),
        "elements": lists(lambda f, *found: exodus.ex_get_processor_elem_maps(f, *found, 0), load[3:5]),
        "node maps": [lists(lambda f, *found: exodus.ex_get_node_cmap(f, *found, 0), [size, size], ctypes.c_longlong(one))
                      for one, size in zip(*maps[:2])],
        "element maps": [lists(lambda f, *found: exodus.ex_get_elem_cmap(f, *found, 0), [size] * 3, ctypes.c_longlong(one))
                         for one, size in zip(*maps[2:])],
        "ids": [maps[0], maps[2]],
        "blocks": lists(exodus.ex_get_eb_info_global, [whole[2]] * 2),
        # without sets, the library is not asked for them
        "node sets": lists(exodus.ex_get_ns_param_global, [whole[3]] * 3) if whole[3] else [[], [], []],
        "side sets": lists(exodus.ex_get_ss_param_global, [whole[4]] * 3) if whole[4] else [[], [], []],
    }
    check(exodus.ex_close(file))
    return result


json.dump([read(path) for path in sys.argv[1:]], sys.stdout)
