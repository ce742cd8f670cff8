"""sealed"""
