"""blind"""
