# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Lists the links of HDF5 files as programs do that do not sort them."""
import h5py


def records_order(group):
    return group.id.get_create_plist().get_link_creation_order() != 0


def listed(path):
    """The names in each group, by creation in the groups that record it."""
    lists = {}

    def add(name, item):
        if isinstance(item, h5py.Group):
            index = h5py.h5.INDEX_CRT_ORDER if records_order(item) else h5py.h5.INDEX_NAME
            lists[name] = []
            item.id.links.iterate(lists[name].append, idx_type=index, order=h5py.h5.ITER_NATIVE)

    with h5py.File(path) as file:
        add("/", file["/"])
        file.visititems(add)
    return lists
