# SPDX-License-Identifier: Apache-2.0
"""For pip: the package holds a shared library, so its wheel is for this kind of machine only."""
from setuptools import Distribution, setup


class WithLibrary(Distribution):
    def has_ext_modules(self):
        return True


setup(distclass=WithLibrary)
